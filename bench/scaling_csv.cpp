#include "bench/scaling_csv.h"

#include <signorini/lcp/io/input_error.h>

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <set>
#include <sstream>

namespace signorini::bench {
namespace {

constexpr std::string_view kWrong = "wrong: ";  // before a failure that no limit explains

std::string head() {
  std::string text = "scene,bodies,engine,accuracy,threads,steps,failure";
  for (const auto& [name, count] : kScalingCounts) text += fmt::format(",{}", name);
  for (const auto& [name, cost] : kScalingCosts) text += fmt::format(",{}", name);
  return text;
}

/// Without what would end a field.
std::string field(std::string text) {
  for (char& c : text) {
    c = c == ',' || c == '\n' || c == '"' ? ';' : c;
  }
  return text;
}

/// The fields of one line, taken one after the other.
class Line {
 public:
  Line(const std::filesystem::path& file, int number, const std::string& text)
      : file_(file), number_(number) {
    std::size_t begin = 0;
    for (std::size_t end = text.find(','); end != std::string::npos; end = text.find(',', begin)) {
      fields_.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
    fields_.push_back(text.substr(begin));
  }
  void expect(std::size_t count) const {
    if (fields_.size() != count) {
      fail(fmt::format("must have {} fields, got {}", count, fields_.size()));
    }
  }
  std::string text() { return fields_[next_++]; }
  long integer(std::string_view name, long least) {
    const std::string& value = fields_[next_++];
    long number = 0;
    const char* end = value.data() + value.size();
    const auto [stop, error] = std::from_chars(value.data(), end, number);
    if (error != std::errc() || stop != end || number < least) {
      fail(fmt::format("{}: must be an integer >= {}, got '{}'", name, least, value));
    }
    return number;
  }
  double cost(std::string_view name) {
    const std::string& value = fields_[next_++];
    if (value == "nan") {
      return ScalingCosts::kUnknown;
    }
    double number = 0.0;
    const char* end = value.data() + value.size();
    const auto [stop, error] = std::from_chars(value.data(), end, number);
    if (error != std::errc() || stop != end || !(number >= 0.0) || !std::isfinite(number)) {
      fail(fmt::format("{}: must be nan, or finite and >= 0, got '{}'", name, value));
    }
    return number;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw lcp::InputError(file_, number_, what);
  }

 private:
  std::filesystem::path file_;
  int number_;
  std::vector<std::string> fields_;
  std::size_t next_ = 0;
};

ScalingRow read_row(Line& line) {
  line.expect(7 + kScalingCounts.size() + kScalingCosts.size());
  constexpr long kMost = 1'000'000'000;
  const auto small = [&](std::string_view name) {
    const long value = line.integer(name, 1);
    if (value > kMost) {
      line.fail(fmt::format("{}: must be at most {}, got {}", name, kMost, value));
    }
    return static_cast<int>(value);
  };
  ScalingRow row;
  row.scene = line.text();
  row.bodies = small("bodies");
  row.engine = line.text();
  row.accuracy = line.text();
  row.threads = small("threads");
  row.steps = small("steps");
  row.failure = line.text();
  row.is_wrong = row.failure.rfind(kWrong, 0) == 0;
  if (row.is_wrong) {
    row.failure.erase(0, kWrong.size());
  }
  for (const auto& [name, count] : kScalingCounts) row.counts.*count = line.integer(name, -1);
  for (const auto& [name, cost] : kScalingCosts) row.costs.*cost = line.cost(name);
  return row;
}

}  // namespace

std::string scaling_key(const ScalingRow& row) {
  return fmt::format("{} of {} bodies, {}{}{}, {} thread{}, {} steps", row.scene, row.bodies,
                     row.engine, row.accuracy.empty() ? "" : " ", row.accuracy, row.threads,
                     row.threads == 1 ? "" : "s", row.steps);
}

std::string write_scaling_csv(const std::vector<ScalingRow>& rows) {
  std::string csv = head() + "\n";
  for (const ScalingRow& row : rows) {
    csv += fmt::format("{},{},{},{},{},{},{}{}", field(row.scene), row.bodies, field(row.engine),
                       field(row.accuracy), row.threads, row.steps, row.is_wrong ? kWrong : "",
                       field(row.failure));
    for (const auto& [name, count] : kScalingCounts) csv += fmt::format(",{}", row.counts.*count);
    for (const auto& [name, cost] : kScalingCosts) {
      const double value = row.costs.*cost;
      csv += std::isfinite(value) ? fmt::format(",{:.6g}", value) : ",nan";
    }
    csv += "\n";
  }
  return csv;
}

std::vector<ScalingRow> read_scaling_csv(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string text;
  if (!std::filesystem::is_regular_file(file) || !in || !std::getline(in, text)) {
    throw lcp::InputError(file, 0, "must be a scaling.csv, and cannot be read or is empty");
  }
  if (text != head()) {
    throw lcp::InputError(file, 1, "must start with '" + head() + "', got '" + text + "'");
  }
  std::vector<ScalingRow> rows;
  std::set<std::string> keys;
  for (int number = 2; std::getline(in, text); ++number) {
    Line line(file, number, text);
    rows.push_back(read_row(line));
    if (!keys.insert(scaling_key(rows.back())).second) {
      line.fail("a second row of " + scaling_key(rows.back()));
    }
  }
  if (rows.empty()) {
    throw lcp::InputError(file, 0, "has no rows");
  }
  return rows;
}

}  // namespace signorini::bench
