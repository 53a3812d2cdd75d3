#include <signorini/lcp/io/input_error.h>

#include <fmt/format.h>
#include <utility>

namespace signorini::lcp {
namespace {

std::string located(const std::filesystem::path& file, int line, const std::string& message) {
  return line > 0 ? fmt::format("{}:{}: {}", file.string(), line, message)
                  : fmt::format("{}: {}", file.string(), message);
}

}  // namespace

InputError::InputError(std::filesystem::path file, int line, const std::string& message)
    : std::runtime_error(located(file, line, message)), file_(std::move(file)), line_(line) {}

}  // namespace signorini::lcp
