#include "sdf_bytes.h"

#include <signorini/validation/input_error.h>
#include <signorini/validation/sdf_reader.h>

#include "byte_reader.h"

#include <string>

namespace signorini::testing {
namespace {

void require_fit_to_run(const validation::Scene& scene) {
  require(scene.bodies.size() == scene.state.size(), "every body has a state");
  for (const BodyState& state : scene.state) {
    require(state.x.allFinite() && state.q.coeffs().allFinite(), "poses are finite");
  }
  for (const Body& body : scene.bodies) {
    require(!body.is_dynamic() || (body.mass > 0.0 && body.inertia.allFinite()), "masses are > 0");
  }
  for (const collision::Collider& collider : scene.colliders) {
    require(collider.body >= 0 && collider.body < std::ssize(scene.bodies),
            "a collider is of one of the bodies");
  }
  try {
    validation::validate(scene);
  } catch (const validation::InputError& error) {
    broken(std::string("what the reader takes is valid: ") + error.what());
  }
}

}  // namespace

void judge_sdf_bytes(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  const validation::ReadOptions options{.skip_unsupported = size % 2 == 1};
  try {
    const validation::Scene scene = validation::read_scene_text(text, "fuzz.sdf", options);
    require_fit_to_run(scene);
    const validation::Scene again = validation::read_scene_text(text, "fuzz.sdf", options);
    require(again.bodies.size() == scene.bodies.size() && again.notices == scene.notices,
            "a scene is read the same again");
  } catch (const validation::InputError& error) {
    require(error.what()[0] != '\0', "an InputError has a text");
  }
}

}  // namespace signorini::testing
