// Your own collision detection, as a ContactFinder: three balls, one above the other, fall on a
// floor that the library knows nothing of, and come to rest on each other.
#include <signorini/core/response/time_stepper.h>

#include <iostream>
#include <stdexcept>

using signorini::Contact;
using signorini::Vec3;

namespace {

constexpr double kRadius = 0.5;  // m

class BallsOverFloor final : public signorini::ContactFinder {
 public:
  void find(const signorini::State& state, double margin,
            signorini::ContactSet& contacts) override {
    contacts.clear();
    for (int a = 1; a < static_cast<int>(state.size()); ++a) {  // body 0 is the floor, z <= 0
      const double height = state[a].x.z() - kRadius;
      if (height <= margin) {
        contacts.push_back(touch(a, 0, state[a].x, Vec3::UnitZ(), height));
      }
      for (int b = 1; b < a; ++b) {
        const Vec3 between = state[a].x - state[b].x;
        const double gap = between.norm() - 2.0 * kRadius;
        if (gap <= margin) {
          contacts.push_back(touch(a, b, state[a].x, between.normalized(), gap));
        }
      }
    }
  }

  std::optional<signorini::FirstContact> first_contact(std::span<const signorini::Motion* const>,
                                                       double, signorini::RestingPairs) override {
    throw std::logic_error("the time stepper asks for no contact times; EventStepper would");
  }

 private:
  static Contact touch(int a, int b, const Vec3& centre_of_a, const Vec3& normal, double gap) {
    Contact contact;
    contact.body_a = a;
    contact.body_b = b;
    contact.normal = normal;  // from B to A
    contact.gap = gap;
    contact.point_a = centre_of_a - kRadius * normal;
    contact.point_b = contact.point_a - gap * normal;
    contact.feature_id = static_cast<std::uint64_t>(a) * 1000 + b;  // the same from step to step
    contact.material = {.friction = 0.5, .restitution = 0.0};
    return contact;
  }
};

}  // namespace

int main() {
  const signorini::Body ball = {
      .mass = 1.0, .inertia = 0.1 * signorini::Mat3::Identity(), .name = "ball"};
  const signorini::Bodies bodies = {
      {.kind = signorini::BodyKind::kFixed, .name = "floor"}, ball, ball, ball};
  signorini::State state(4);
  state[1].x = Vec3(0.0, 0.0, 1.0);
  state[2].x = Vec3(0.0, 0.0, 2.5);
  state[3].x = Vec3(0.0, 0.0, 4.0);

  BallsOverFloor finder;
  signorini::TimeStepper stepper(bodies, finder, {.step = 1.0 / 240.0, .solver = "auto"});
  signorini::StepReport report;
  bool solved = true;
  for (int i = 0; i < 480; ++i) {
    stepper.step(state, report);
    solved = solved && is_solved(report.status);
  }
  std::cout << (solved ? "every step solved" : "not every step solved")
            << ": z = " << state[1].x.z() << " " << state[2].x.z() << " " << state[3].x.z()
            << " m, " << report.contacts.size() << " contacts\n";
  return solved ? 0 : 1;
}
