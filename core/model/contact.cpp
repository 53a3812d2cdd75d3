#include <signorini/core/model/contact.h>
#include <signorini/core/model/number_text.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace signorini {
namespace {

constexpr double kUnitNormal = 1e-9;

[[noreturn]] void refuse(std::size_t contact, const std::string& what) {
  throw std::invalid_argument("contact " + std::to_string(contact) + ": " + what);
}

void validate_body(std::size_t contact, const char* field, int body, int body_count) {
  if (body < 0 || body >= body_count) {
    refuse(contact, std::string(field) + ": must be in [0, " + std::to_string(body_count) +
                        "), got " + std::to_string(body));
  }
}

void validate_point(std::size_t contact, const char* field, const Vec3& point) {
  if (!point.allFinite()) {
    refuse(contact, std::string(field) + ": must be finite, got " + number_text(point) + " m");
  }
}

void validate_normal(std::size_t contact, const Vec3& normal) {
  if (normal.isZero(0.0)) {
    refuse(contact, "normal: must be a unit vector, got the zero vector");
  }
  if (!(std::abs(normal.norm() - 1.0) <= kUnitNormal)) {
    refuse(contact, "normal: must be a unit vector to 1e-9, got " + number_text(normal) +
                        " of length " + number_text(normal.norm()));
  }
}

void validate_surface(std::size_t contact, const std::string& field, const LocalSurface& surface) {
  if (!(surface.radius_along >= 0.0)) {
    refuse(contact, field + ".radius_along: must be in [0, infinity], got " +
                        number_text(surface.radius_along) + " m");
  }
  if (!(surface.radius_across >= 0.0)) {
    refuse(contact, field + ".radius_across: must be in [0, infinity], got " +
                        number_text(surface.radius_across) + " m");
  }
  if (!(std::abs(surface.direction.norm() - 1.0) <= kUnitNormal)) {
    refuse(contact, field + ".direction: must be a unit vector to 1e-9, got " +
                        number_text(surface.direction));
  }
}

}  // namespace

void validate(const ContactSet& contacts, int body_count) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Contact& contact = contacts[i];
    validate_body(i, "body_a", contact.body_a, body_count);
    validate_body(i, "body_b", contact.body_b, body_count);
    if (contact.body_a == contact.body_b) {
      refuse(i, "body_b: must differ from body_a, both are " + std::to_string(contact.body_a));
    }
    validate_point(i, "point_a", contact.point_a);
    validate_point(i, "point_b", contact.point_b);
    validate_normal(i, contact.normal);
    if (!std::isfinite(contact.gap)) {
      refuse(i, "gap: must be finite, got " + number_text(contact.gap) + " m");
    }
    validate_surface(i, "surface_a", contact.surface_a);
    validate_surface(i, "surface_b", contact.surface_b);
    if (!contact.friction_direction.allFinite()) {
      refuse(i,
             "friction_direction: must be finite, got " + number_text(contact.friction_direction));
    }
    try {
      validate(contact.material);
    } catch (const std::invalid_argument& error) {
      refuse(i, error.what());
    }
  }
}

}  // namespace signorini
