#include "settings.h"

#include <signorini/lcp/number_text.h>

#include "guard.h"

#include <cmath>

#ifdef SIGNORINI_HAS_IO
#include <signorini/lcp/io/dump_recorder.h>
#endif

namespace signorini::c {
namespace {

[[noreturn]] void refuse_name(std::string_view name, const char* known) {
  refuse("setting: \"" + std::string(name) + "\" is not known; known: " + known);
}

std::shared_ptr<lcp::SolveRecorder> make_recorder([[maybe_unused]] const std::string& value) {
#ifdef SIGNORINI_HAS_IO
  try {
    return std::make_shared<lcp::DumpRecorder>(lcp::DumpSettings::parse(value));
  } catch (const std::runtime_error& error) {
    refuse(error.what());
  }
#else
  refuse("setting: dump: this library was built without lcp/io (SIGNORINI_BUILD_IO=OFF)");
#endif
}

}  // namespace

int whole_number(std::string_view setting, double value) {
  if (!(std::abs(value) <= 2147483647.0) || value != std::floor(value)) {
    refuse("settings: " + std::string(setting) + ": must be a whole number below 2^31, got " +
           lcp::number_text(value));
  }
  return static_cast<int>(value);
}

bool flag(std::string_view setting, double value) {
  if (value != 0.0 && value != 1.0) {
    refuse("settings: " + std::string(setting) + ": must be 0 or 1, got " +
           lcp::number_text(value));
  }
  return value == 1.0;
}

void NamedSettings::set_number(std::string_view name, double value) {
  lcp::SolverSettings changed = lcp;
  if (name == "tolerance") {
    changed.tolerance = value;
  } else if (name == "max_iterations") {
    changed.max_iterations = whole_number(name, value);
  } else if (name == "time_limit") {
    changed.time_limit = value;
  } else if (name == "certify_islands") {
    changed.certify_islands = flag(name, value);
  } else if (name == "quick_certificate") {
    changed.quick_certificate = flag(name, value);
  } else {
    refuse_name(name, "tolerance, max_iterations, time_limit, certify_islands, quick_certificate");
  }
  changed.validate();
  lcp = changed;
}

void NamedSettings::set_text(std::string_view name, const std::string& value) {
  if (name != "dump") {
    refuse_name(name, "dump");
  }
  recorder = value.empty() ? nullptr : make_recorder(value);
  lcp.recorder = recorder.get();
}

}  // namespace signorini::c
