#pragma once

#include <signorini/validation/report.h>

#include <string>
#include <string_view>

namespace signorini::validation {

/// The text of report.md: the verdict table of all scenes, failed ones first, then a section for
/// each scene with its checks, tables, settings, notices and command. Plots are listed with their
/// ranges. GitHub-flavoured Markdown.
///
/// @param no_page_because  why there is no report.html beside it; empty if there is one.
[[nodiscard]] std::string report_markdown(const Report& report, std::string_view no_page_because);

/// Text as it must be written to stand in a cell of a Markdown table, or in a line: characters that
/// Markdown or HTML would read (| \ ` * _ [ ] < > # ~ &) escaped, line breaks as spaces.
[[nodiscard]] std::string markdown_escaped(std::string_view text);

/// Text in a fenced block whose fence is longer than any run of backticks in the text.
[[nodiscard]] std::string markdown_fenced(std::string_view text);

}  // namespace signorini::validation
