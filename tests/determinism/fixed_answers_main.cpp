// Writes what the library answers to a fixed input, or compares it with what another run or another
// build wrote:
//   fixed_answers write FILE
//   fixed_answers compare FILE bits|bounds [THREADS]
// Exits with 1 where the bits differ, or a choice or more than the bounds of fixed_answers.h.
#include "fixed_answers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>
#include <stdexcept>
#include <string>

namespace signorini::testing {
namespace {

/// A number's bits: what is written is what is read.
void write(const std::vector<double>& numbers, std::ostream& file) {
  for (const double number : numbers) {
    file << std::bit_cast<std::uint64_t>(number) << "\n";
  }
}

std::vector<double> read(std::size_t count, std::istream& file) {
  std::vector<double> numbers(count);
  for (double& number : numbers) {
    std::uint64_t bits = 0;
    file >> bits;
    number = std::bit_cast<double>(bits);
  }
  return numbers;
}

void write(const std::vector<FixedAnswers>& all, const std::string& path) {
  std::ofstream file(path);
  for (const FixedAnswers& answers : all) {
    file << answers.part << "\n"
         << answers.choices.size() << " " << answers.numbers.size() << " "
         << answers.left_open.size() << "\n";
    for (const std::int64_t choice : answers.choices) {
      file << choice << "\n";
    }
    write(answers.numbers, file);
    write(answers.left_open, file);
  }
  file.close();
  if (!file) {
    throw std::runtime_error("cannot write " + path);
  }
}

FixedAnswers read(std::istream& file) {
  FixedAnswers answers;
  std::size_t choices = 0;
  std::size_t numbers = 0;
  std::size_t left_open = 0;
  std::getline(file, answers.part);
  file >> choices >> numbers >> left_open;
  if (!file) {
    throw std::runtime_error("the file cannot be read, ends early, or is none of ours");
  }
  answers.choices.resize(choices);
  for (std::int64_t& choice : answers.choices) {
    file >> choice;
  }
  answers.numbers = read(numbers, file);
  answers.left_open = read(left_open, file);
  file.ignore(1, '\n');
  if (!file) {
    throw std::runtime_error("the file ends early");
  }
  return answers;
}

struct Difference {
  std::size_t numbers = 0;  ///< whose bits differ
  double largest = 0.0;     ///< over the largest |number|
};

Difference difference(const std::vector<double>& these, const std::vector<double>& those) {
  Difference found;
  double largest_number = 0.0;
  for (std::size_t k = 0; k < these.size(); ++k) {
    if (std::bit_cast<std::uint64_t>(these[k]) != std::bit_cast<std::uint64_t>(those[k])) {
      ++found.numbers;
      const double gap = std::abs(these[k] - those[k]);
      found.largest =
          std::isnan(gap) ? std::numeric_limits<double>::infinity() : std::max(found.largest, gap);
    }
    largest_number = std::max(largest_number, std::abs(those[k]));
  }
  if (found.largest != 0.0) {
    found.largest /= largest_number;
  }
  return found;
}

/// Prints a line; false: not as it must be.
bool compare(const FixedAnswers& these, const FixedAnswers& those, bool bits) {
  std::printf("%-28s", these.part.c_str());
  if (these.part != those.part || these.numbers.size() != those.numbers.size() ||
      these.left_open.size() != those.left_open.size() || these.choices != those.choices) {
    std::printf("  NOT KEPT: other statuses, counts or features\n");
    return false;
  }
  const Difference found = difference(these.numbers, those.numbers);
  const std::size_t others = difference(these.left_open, those.left_open).numbers;
  const bool holds = bits ? found.numbers + others == 0 : found.largest <= these.bound;
  std::printf(
      "%5zu numbers, %4zu with other bits, by at most %-8.2g (bound %g); %4zu of %4zu more%s\n",
      these.numbers.size(), found.numbers, found.largest, bits ? 0.0 : these.bound, others,
      these.left_open.size(), holds ? "" : "  NOT KEPT");
  return holds;
}

int run(const std::vector<std::string>& words) {
  const bool is_write = words.size() == 2 && words[0] == "write";
  const bool is_compare = (words.size() == 3 || words.size() == 4) && words[0] == "compare" &&
                          (words[2] == "bits" || words[2] == "bounds");
  if (!is_write && !is_compare) {
    std::cerr << "usage: fixed_answers write FILE | compare FILE bits|bounds [THREADS]\n";
    return 64;
  }
  const std::vector<FixedAnswers> all = fixed_answers(words.size() == 4 ? std::stoi(words[3]) : 1);
  if (is_write) {
    write(all, words[1]);
    return 0;
  }
  std::ifstream file(words[1]);
  bool same = true;
  for (const FixedAnswers& answers : all) {
    same = compare(answers, read(file), words[2] == "bits") && same;
  }
  return same ? 0 : 1;
}

}  // namespace
}  // namespace signorini::testing

int main(int argc, char** argv) {
  try {
    return signorini::testing::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "fixed_answers: " << error.what() << "\n";
    return 65;
  }
}
