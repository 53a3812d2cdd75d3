#include <signorini/core/model/number_text.h>
#include <signorini/core/response/step_report.h>

#include <utility>

namespace signorini {

void start_report(StepReport& report) {
  StepReport fresh;
  const auto keep = [&](auto StepReport::*member) {
    std::swap(fresh.*member, report.*member);
    (fresh.*member).clear();
  };
  keep(&StepReport::contacts);
  keep(&StepReport::impulses);
  keep(&StepReport::moments);
  keep(&StepReport::island_of);
  keep(&StepReport::joints);
  keep(&StepReport::accuracy);
  keep(&StepReport::detail);
  std::swap(fresh.islands, report.islands);  // with their texts; resized when their number is known
  std::swap(fresh.normal_impulses, report.normal_impulses);
  std::swap(fresh.result, report.result);
  lcp::start_result(fresh.result.z.size(), fresh.result);
  report = std::move(fresh);
}

std::string to_text(const StepReport& report) {
  const auto count = [](std::size_t number) { return std::to_string(number); };
  std::string text =
      count(report.contacts.size()) + " contacts, " + count(report.islands.size()) + " islands, " +
      std::to_string(report.rows) + " rows; left out: " + std::to_string(report.contacts_left_out) +
      " contacts about to bounce, " + std::to_string(report.contacts_apart) +
      " contacts apart (put back: " + std::to_string(report.contacts_put_back) + "), " +
      std::to_string(report.tangents_left_out) + " tangents without friction, " +
      std::to_string(report.rotations_left_out) + " rotations of bodies that nothing can turn, " +
      std::to_string(report.dynamic_bodies_without_rows) + " bodies without contact\n";
  if (report.bodies_asleep + report.bodies_woken > 0) {
    text += std::to_string(report.bodies_asleep) +
            " bodies asleep (woken: " + std::to_string(report.bodies_woken) + "), " +
            std::to_string(report.contacts_asleep) + " contacts of theirs left out\n";
  }
  if (!report.accuracy.empty()) {
    text += "accuracy: " + report.accuracy + ", " + number_text(report.work) + " units of work" +
            (report.is_deterministic ? "" : ", limited by time: not deterministic") + "\n";
  }
  text += "seconds: find " + number_text(report.seconds.find) + ", solve " +
          number_text(report.seconds.solve) + " (rows " + number_text(report.seconds.assemble) +
          ", solvers " + number_text(report.seconds.solvers) + ", move " +
          number_text(report.seconds.move) + "), project " + number_text(report.seconds.project) +
          "\n";
  for (std::size_t k = 0; k < report.islands.size(); ++k) {
    const IslandReport& island = report.islands[k];
    text += "island " + count(k) + ": " + std::to_string(island.bodies) + " bodies, " +
            std::to_string(island.contacts) + " contacts, " +
            (island.joint_rows > 0 ? std::to_string(island.joint_rows) + " joint rows, " : "") +
            std::to_string(island.rows) + " rows, " + island.model + ", " + island.solver + ": " +
            std::string(lcp::to_string(island.status)) + ", residual " +
            number_text(island.unit_free_residual) + " (" + number_text(island.residual) +
            " m/s)\n";
  }
  return text;
}

}  // namespace signorini
