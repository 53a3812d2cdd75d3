#pragma once

#include <signorini/core/response/event_stepper.h>
#include <signorini/validation/run_control.h>
#include <signorini/validation/scene.h>
#include <signorini/validation/track.h>

#include <string>
#include <vector>

namespace signorini::validation {

/// The settings a scene is run with: EventSettings' defaults, the scene's gravity.
[[nodiscard]] EventSettings event_settings(const Scene& scene);

/// Runs the scene from event to event with collision::CollisionWorld and EventStepper; its step is
/// that of what is recorded, and changes nothing. A run that meets a problem which is not solved
/// ends there (Track::unsolved_steps, first_unsolved), as does one whose numbers stop being finite.
/// Contact forces are shown as they act at the end of a record.
/// @param stop null, or a flag that ends the run early (Track::interrupted)
/// @param watch empty, or told after every record
/// @throws std::invalid_argument for contacts that resist turning, which the stepper does not take
[[nodiscard]] Track run_by_events(const Scene& scene, const EventSettings& settings,
                                  const StopFlag* stop = nullptr,
                                  const StepWatcher& watch = nullptr);

/// How the run was made, one line a setting, for the report.
[[nodiscard]] std::vector<std::string> describe(const EventSettings& settings);

}  // namespace signorini::validation
