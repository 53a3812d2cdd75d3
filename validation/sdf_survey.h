#pragma once

#include <map>
#include <sdf/Element.hh>
#include <string>
#include <vector>

namespace signorini::validation {

/// What a document holds beside what a run uses, found by walking its elements before libsdformat
/// builds its objects.
class SdfSurvey {
 public:
  SdfSurvey(std::string source, bool skip_unsupported)
      : source_(std::move(source)), skip_unsupported_(skip_unsupported) {}

  /// Walks an element and everything below it, explicitly written elements only. Removes
  /// unsupported elements from the tree if they are to be skipped.
  /// @throws InputError naming file, line, model, link and element: an unsupported shape or joint;
  /// mass or inertia that no body has; an unknown <signorini:...> element.
  void walk(const sdf::ElementPtr& element);

  /// Elements without physics that were left out before the survey.
  void count_without_physics(const std::string& element, int count) {
    without_physics_[element] += count;
  }

  /// One line for what has no physics, one for ignored physics, one for each skipped element.
  [[nodiscard]] std::vector<std::string> notices() const;

  /// True if the link had shapes and every one of them was skipped.
  [[nodiscard]] bool was_emptied(const sdf::Element& link) const;

  /// "model 'm', link 'l'": as path_of() of xml_check.h.
  [[nodiscard]] static std::string path(const sdf::Element& element);
  /// "FILE:12: model 'm', link 'l'".
  [[nodiscard]] std::string locate(const sdf::Element& element) const;

 private:
  struct Mention {
    int count = 0;
    std::string first;  ///< where
  };

  void walk_children(const sdf::ElementPtr& element);
  void mention_ignored(const sdf::ElementPtr& element);
  [[nodiscard]] std::string unsupported(const sdf::ElementPtr& element) const;
  void check_inertial(const sdf::ElementPtr& inertial) const;
  void check_friction(const sdf::ElementPtr& ode);

  std::string source_;
  bool skip_unsupported_;
  std::map<std::string, int> without_physics_;
  std::map<std::string, Mention> ignored_physics_;
  std::vector<std::string> skipped_;
  std::vector<std::string> links_with_skips_;  ///< as located
};

/// Whether a <friction><ode> has two coefficients, both > 0, and the direction <fdir1> of the
/// first.
[[nodiscard]] bool is_anisotropic(const sdf::Element& ode);

}  // namespace signorini::validation
