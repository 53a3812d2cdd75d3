#pragma once

#include <string>
#include <string_view>

namespace signorini::validation {

/// The page without data, as the app in validation/report/ was built into this library; empty if
/// the library was built without it. It holds kReportPlaceholder exactly once.
[[nodiscard]] std::string_view report_page_template();

/// Why report_page_template() is empty ("this build had no node"); empty if it is not.
[[nodiscard]] std::string_view report_page_absent_because();

/// Where the JSON text stands in the template.
inline constexpr std::string_view kReportPlaceholder = "SIGNORINI_REPORT_JSON";

/// report.html: the template with the text of report_page_json() in the placeholder's stead.
/// @throws std::logic_error if the template does not hold the placeholder exactly once.
[[nodiscard]] std::string report_page(std::string_view page_template, std::string_view json);

}  // namespace signorini::validation
