#pragma once

#include <signorini/validation/report.h>

#include <string>

namespace signorini::validation {

/// The text of report.json: every number as the shortest decimal that reads back as the same
/// double, NaN and infinity as the strings "NaN", "Infinity" and "-Infinity", times of an engine
/// that was not run as null. One line, ended by a newline. Fields: docs/report-schema.md.
[[nodiscard]] std::string report_json(const Report& report);

/// The same document for the page report.html: lines of plots thinned (series_thinning.h) and
/// rounded to 7 significant digits, each with its "points" in report.json; every '<' is written
/// \u003c, so that the text can stand inside a <script> element.
[[nodiscard]] std::string report_page_json(const Report& report);

/// Where a scene's file is kept, relative to the report's folder: "scenes/01-NAME.sdf", letters
/// that a file name may not hold replaced by "_".
[[nodiscard]] std::string scene_file_name(const Report& report, std::size_t index);

}  // namespace signorini::validation
