#include <signorini/validation/report_page.h>

#include <stdexcept>

namespace signorini::validation {

std::string report_page(std::string_view page_template, std::string_view json) {
  const std::size_t at = page_template.find(kReportPlaceholder);
  if (at == std::string_view::npos || page_template.rfind(kReportPlaceholder) != at) {
    throw std::logic_error("the template of report.html must hold its placeholder exactly once");
  }
  std::string result;
  result.reserve(page_template.size() + json.size());
  result += page_template.substr(0, at);
  result += json;
  result += page_template.substr(at + kReportPlaceholder.size());
  return result;
}

}  // namespace signorini::validation
