#include <signorini/validation/report_bytes.h>

#include "tools/byte_archive.h"

namespace signorini::validation {

using tools::Reflects;

void visit_fields(auto& archive, Reflects<Check> auto& check) {
  archive(check.name, check.engine, check.reference, check.unit, check.value, check.expected,
          check.error, check.tolerance, check.error_kind, check.reason, check.verdict);
}
void visit_fields(auto& archive, Reflects<Series> auto& series) {
  archive(series.name, series.engine, series.x, series.y);
}
void visit_fields(auto& archive, Reflects<Plot> auto& plot) {
  archive(plot.title, plot.x_label, plot.y_label, plot.log_y, plot.series);
}
void visit_fields(auto& archive, Reflects<Table> auto& table) {
  archive(table.title, table.header, table.rows);
}
void visit_fields(auto& archive, Reflects<TradePoint> auto& point) {
  archive(point.solver, point.engine, point.step, point.error, point.whole_seconds,
          point.solver_seconds);
}
void visit_fields(auto& archive, Reflects<Trade> auto& trade) {
  archive(trade.error, trade.unit, trade.reference, trade.scale, trade.duration, trade.points);
}
void visit_fields(auto& archive, Reflects<Playback::DrawnBody> auto& body) {
  archive(body.name, body.kind, body.initial);
}
void visit_fields(auto& archive, Reflects<Playback::Surface> auto& surface) {
  archive(surface.vertices, surface.triangles, surface.whole_triangles);
}
void visit_fields(auto& archive, Reflects<Playback::DrawnShape> auto& shape) {
  archive(shape.name, shape.body, shape.kind, shape.sizes, shape.surface, shape.local);
}
void visit_fields(auto& archive, Reflects<Playback::DrawnJoint> auto& joint) {
  archive(joint.name, joint.kind, joint.body_a, joint.body_b, joint.anchor_a, joint.anchor_b);
}
void visit_fields(auto& archive, Reflects<Playback::Frame> auto& frame) {
  archive(frame.time, frame.poses, frame.contacts, frame.all_contacts);
}
void visit_fields(auto& archive, Reflects<Playback::PlaybackTrack> auto& track) {
  archive(track.engine, track.frames);
}
void visit_fields(auto& archive, Reflects<Playback> auto& playback) {
  archive(playback.gravity, playback.bodies, playback.shapes, playback.joints, playback.surfaces,
          playback.tracks);
}
void visit_fields(auto& archive, Reflects<SceneReport> auto& report) {
  archive(report.name, report.title, report.description, report.source, report.text, report.builtin,
          report.command, report.settings, report.notices, report.checks, report.plots,
          report.tables, report.trade, report.signorini_seconds, report.bullet_seconds,
          report.playback, report.signorini_solver_seconds, report.bullet_solver_seconds);
}

std::string scene_report_bytes(const SceneReport& report) {
  return tools::to_bytes(report);
}

SceneReport scene_report_from_bytes(std::string_view bytes) {
  return tools::from_bytes<SceneReport>(bytes);
}

}  // namespace signorini::validation
