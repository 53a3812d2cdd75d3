#include <signorini/lcp/io/matrix_market.h>
#include <signorini/lcp/io/result_writer.h>
#include <signorini/lcp/io/whole_file.h>
#include <signorini/lcp/solver.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace signorini::lcp {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  if (std::isnan(value)) {
    return nullptr;
  }
  if (std::isinf(value)) {
    return value > 0.0 ? "inf" : "-inf";
  }
  return value;
}

Json counter(std::int64_t value) {
  return value < 0 ? Json(nullptr) : Json(value);
}

Json certificate_object(const Certificate& certificate) {
  return {{"natural_residual", number(certificate.natural_residual)},
          {"unit_free_residual", number(certificate.unit_free_residual)},
          {"natural_floor", number(certificate.natural_floor)},
          {"rounding_floor", number(certificate.rounding_floor)},
          {"backward_error", number(certificate.backward_error)},
          {"min_z", number(certificate.min_z)},
          {"min_w", number(certificate.min_w)},
          {"complementarity", number(certificate.complementarity)},
          {"cone_violation", number(certificate.cone_violation)},
          {"worst_row", counter(certificate.worst_row)}};
}

Json attempt_object(const Attempt& attempt) {
  return {{"solver", attempt.solver},
          {"reason", attempt.reason},
          {"status", to_string(attempt.status)},
          {"natural_residual", number(attempt.natural_residual)},
          {"unit_free_residual", number(attempt.unit_free_residual)},
          {"iterations", counter(attempt.statistics.iterations)},
          {"pivots", counter(attempt.statistics.pivots)},
          {"factorizations", counter(attempt.statistics.factorizations)},
          {"solve_seconds", number(attempt.statistics.solve_seconds)},
          {"detail", attempt.detail}};
}

/// Every island: its rows, whether it is solved by itself, its certificate.
Json islands_array(const Result& result, double tolerance) {
  Json array = Json::array();
  for (const Certificate& certificate : result.island_certificates) {
    array.push_back({{"solved", is_solved(judge(certificate, tolerance, Status::kStalled))},
                     {"rows", Json::array()},
                     {"certificate", certificate_object(certificate)}});
  }
  for (std::size_t i = 0; i < result.island_of_row.size(); ++i) {
    array[static_cast<std::size_t>(result.island_of_row[i])]["rows"].push_back(i);
  }
  return array;
}

Json result_object(const Result& result, double tolerance) {
  Json json = {{"status", to_string(result.status)},
               {"solved", is_solved(result.status)},
               {"solver", result.solver},
               {"detail", result.detail},
               {"iterations", counter(result.statistics.iterations)},
               {"pivots", counter(result.statistics.pivots)},
               {"factorizations", counter(result.statistics.factorizations)},
               {"refinements", counter(result.statistics.refinements)},
               {"factor_bytes", counter(result.statistics.factor_bytes)},
               {"solve_seconds", number(result.statistics.solve_seconds)},
               {"certificate", certificate_object(result.certificate)},
               {"ray_bound", number(result.ray_bound)}};
  if (!result.island_of_row.empty()) {
    json["islands"] = islands_array(result, tolerance);
  }
  if (!result.attempts.empty()) {
    json["attempts"] = Json::array();
    for (const Attempt& attempt : result.attempts) {
      json["attempts"].push_back(attempt_object(attempt));
    }
  }
  return json;
}

void add_law(std::string_view friction_law, Json& json) {
  if (!friction_law.empty()) {
    json["friction_law"] = friction_law;
  }
}

Json array_of(std::span<const Result> results, double tolerance) {
  Json array = Json::array();
  for (const Result& result : results) {
    array.push_back(result_object(result, tolerance));
  }
  return array;
}

std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string vector_text(const Vector& vector) {
  std::string text;
  for (const double value : vector) {
    append_number(value, text);
    text += '\n';
  }
  return text;
}

void write_vector(const std::filesystem::path& file, const Vector& vector) {
  write_whole_file(file, vector_text(vector));
}

std::string result_json(const Result& result, double tolerance, std::string_view friction_law,
                        int indent) {
  Json json = result_object(result, tolerance);
  add_law(friction_law, json);
  return text_of(json, indent);
}

std::string results_json(std::span<const Result> results, double tolerance,
                         std::span<const std::string> left_out, std::string_view friction_law,
                         int indent) {
  Json json;
  json["results"] = array_of(results, tolerance);
  json["left_out"] = std::vector<std::string>(left_out.begin(), left_out.end());
  add_law(friction_law, json);
  return text_of(json, indent);
}

std::string record_json(const SolveRecord& record) {
  const SolverSettings& settings = record.settings;
  const Json json = {{"solver", record.solver},
                     {"settings",
                      {{"tolerance", number(settings.tolerance)},
                       {"max_iterations", counter(settings.max_iterations)},
                       {"time_limit", number(settings.time_limit)}}},
                     {"result", result_object(record.result, settings.tolerance)}};
  return text_of(json, 2);
}

}  // namespace signorini::lcp
