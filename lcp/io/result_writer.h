#pragma once

#include <signorini/lcp/result.h>
#include <signorini/lcp/solve_recorder.h>
#include <signorini/lcp/types.h>

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace signorini::lcp {

/// A vector as text, one number a line with 17 significant digits.
[[nodiscard]] std::string vector_text(const Vector& vector);

/// Writes a vector, one number a line with 17 significant digits, whole or not at all.
/// @throws std::runtime_error naming the file, see write_whole_file()
void write_vector(const std::filesystem::path& file, const Vector& vector);

/// A result as a JSON object (without z and w): status, solver, detail, iterations, pivots,
/// factorizations, refinements, factor_bytes, solve_seconds, certificate (its members by their
/// names), ray_bound, islands where they were certified (an array: whether the island is solved by
/// itself, its rows, its certificate), and attempts where the solver tried others. Numbers with as
/// many digits as read back to the same bits. null: there is no such number (NaN, or a counter that
/// the solver does not have); infinity is the string "inf" or "-inf", since JSON has no number for
/// it.
/// @param tolerance the one that was asked for
/// @param friction_law of the problem's cones, as friction_law; left out if empty
/// @param indent spaces a level, -1: all on one line
[[nodiscard]] std::string result_json(const Result& result, double tolerance,
                                      std::string_view friction_law = {}, int indent = 2);

/// Several results as a JSON object with the arrays `results` and `left_out`.
/// @param left_out one line for each solver that was not run: which and why
[[nodiscard]] std::string results_json(std::span<const Result> results, double tolerance,
                                       std::span<const std::string> left_out = {},
                                       std::string_view friction_law = {}, int indent = 2);

/// A recorded solve as a JSON object: solver, settings (tolerance, max_iterations, time_limit) and
/// result, as in result_json().
[[nodiscard]] std::string record_json(const SolveRecord& record);

}  // namespace signorini::lcp
