// report_sample FOLDER: writes the report of sample_report.h into a folder, for the tests
// of the page.
#include <signorini/validation/report.h>

#include "tests/validation/sample_report.h"

#include <cstdio>
#include <exception>
#include <string>

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: report_sample FOLDER\n");
    return 64;
  }
  try {
    const signorini::validation::Report report = signorini::validation::sample_report();
    for (const std::string& file : signorini::validation::write_report(report, argv[1])) {
      std::printf("%s\n", file.c_str());
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "report_sample: %s\n", error.what());
    return 1;
  }
  return 0;
}
