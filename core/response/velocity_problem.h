#pragma once

#include <signorini/core/response/contact_memory.h>
#include <signorini/core/response/friction_cones.h>
#include <signorini/core/response/friction_pyramid.h>
#include <signorini/core/response/turning_rows.h>

#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

namespace signorini {

/// What a friction force is bounded by.
enum class FrictionModel : std::uint8_t {
  kPyramid,  ///< a pyramid of k sides inside the cone, first side along the slip; an LCP:
             ///< friction_pyramid.h
  kCone,     ///< Coulomb's cone, friction against the slip in every direction: friction_cones.h
  kBox,      ///< |beta_1| <= mu f, |beta_2| <= mu f apart, t1 along the slip: up to sqrt 2 mu f; an
             ///< LCP with bounds coupled to f
};

/// "pyramid", "cone", "box" or "unknown model".
[[nodiscard]] std::string_view to_string(FrictionModel model);

/// A step's contact problem in one of the models, with the same questions to each.
class VelocityProblem {
 public:
  /// @param sides of the pyramid; see assemble_pyramid() and assemble_cones()
  /// @param joints rows with these bodies' numbers, behind all others in every model; those of
  /// rolling and spinning friction (turning_rows.h), with limits coupled to their normals, are
  /// before them
  /// @param columns as start_rows()
  void assemble(FrictionModel model, const Bodies& bodies, const State& free_state,
                const ContactSet& contacts, const lcp::VectorRef& allowance, int sides,
                std::span<const JointRow> joints = {},
                BodyColumns columns = BodyColumns::kThatForcesReach);

  [[nodiscard]] const lcp::Problem& problem() const;
  /// Of J, over all bodies.
  [[nodiscard]] int columns() const;
  /// f of a contact, N s.
  [[nodiscard]] double normal_impulse(const lcp::VectorRef& z, std::size_t contact) const;
  /// z of the joint rows.
  [[nodiscard]] lcp::VectorRef joint_impulses(const lcp::Vector& z) const {
    return z.tail(joints_);
  }
  /// On A, world axes, N s, one a contact.
  void impulses(const ContactSet& contacts, const lcp::VectorRef& z,
                std::vector<Vec3>& impulses) const;
  /// Of rolling and spinning friction, on A, world axes, N m s, one a contact.
  void moments(const lcp::VectorRef& z, std::vector<Vec3>& moments) const;
  /// Adds to memory; see ContactMemory::add().
  void remember(const ContactSet& contacts, const lcp::VectorRef& z, bool corrected,
                ContactMemory& memory) const;
  /// The solution of a single contact without joints and without rolling and spinning friction
  /// where it has a closed form: without friction f = max(0, -q/A); with a cone or a box 0 where
  /// q_N >= 0, else -A^-1 q where that is within the bounds. @return whether it has; z is written
  /// only then
  [[nodiscard]] bool closed_form(lcp::Vector& z) const;
  /// See ContactMemory::recall().
  ContactMemory::Recalled recall(const ContactSet& contacts, const ContactMemory& memory,
                                 lcp::Vector& z) const;

 private:
  [[nodiscard]] bool has_turning(int normal_row, const ConeProblem& cones) const;
  void limit_turning();

  std::variant<PyramidProblem, ConeProblem> form_;
  std::vector<TurningRow> turning_;  // rows before those of the joints
  std::vector<JointRow> behind_;     // both
  Eigen::Index contacts_ = 0;
  Eigen::Index joints_ = 0;  // rows
};

}  // namespace signorini
