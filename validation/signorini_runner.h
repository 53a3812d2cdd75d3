#pragma once

#include <signorini/core/response/time_stepper.h>
#include <signorini/validation/run_control.h>
#include <signorini/validation/scene.h>
#include <signorini/validation/track.h>

#include <string>
#include <string_view>
#include <vector>

namespace signorini::validation {

/// TimeStepSettings' defaults, the scene's step and gravity; more than 12 moving bodies: cones.
[[nodiscard]] TimeStepSettings step_settings(const Scene& scene);

/// Runs the scene with collision::CollisionWorld and TimeStepper. A step whose contact problem is
/// not solved is counted, its best iterate used, and the run goes on; a run whose numbers stop
/// being finite ends there (Track::broke_down).
/// @param stop null, or a flag that ends the run early (Track::interrupted)
/// @param watch empty, or told after every step
[[nodiscard]] Track run_signorini(const Scene& scene, const TimeStepSettings& settings,
                                  const StopFlag* stop = nullptr,
                                  const StepWatcher& watch = nullptr);

/// The text of an integrator, for example "energy-momentum".
[[nodiscard]] std::string_view integrator_name(Integrator integrator);

/// How the run was made, one line a setting, for the report.
[[nodiscard]] std::vector<std::string> describe(const TimeStepSettings& settings);

}  // namespace signorini::validation
