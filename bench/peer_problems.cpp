#include "bench/peer_problems.h"

#include <signorini/lcp/io/problem_folder.h>

#include "bench/classic_problems.h"
#include "bench/contact_families.h"
#include "bench/friction_forms.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

namespace signorini::bench {
namespace {

bool is_contact_family(const std::string& family) {
  const auto names = family_names();
  return std::find(names.begin(), names.end(), family) != names.end();
}

/// Contacts of a pyramid of `layers` layers: 4 k^2 on the ground, 16 j^2 on a layer of j^2 boxes.
int pyramid3d_contacts(int layers) {
  int contacts = 4 * layers * layers;
  for (int j = 1; j < layers; ++j) {
    contacts += 16 * j * j;
  }
  return contacts;
}

/// Contacts of a wall of s x s bricks.
int wall_contacts(int s) {
  const int half_rows = (s - 1) * (2 * s - 1);  // pairs (brick above, brick below)
  return 4 * s + 4 * half_rows + 4 * s * (s - 1);
}

std::string ratio_text(double ratio) {
  return ratio == 1.0 ? "R1" : fmt::format("R1e{:g}", std::log10(ratio));
}

lcp::Problem make_form(const std::string& form, const FamilySpec& spec, double mu) {
  if (form == "lcp") {
    return make_family(spec);
  }
  const FamilyScene scene = make_family_scene(spec);
  if (form == "cone") {
    return make_cones(scene, mu);
  }
  return form == "pyramid" ? make_pyramid_lcp(scene, mu) : make_coupled_box(scene, mu);
}

void add_contacts(const PeerProblemOptions& options, const std::string& form,
                  const std::string& family, std::vector<PeerProblem>& problems) {
  for (const bool at_rest : {false, true}) {
    if (at_rest ? !options.at_rest : !options.moving) {
      continue;
    }
    for (const double ratio : options.mass_ratios) {
      for (const int n : options.sizes) {
        const int size = family_size(family, n);
        const int rows = family_contacts(family, size);
        PeerProblem problem;
        problem.form = form;
        problem.family = family;
        problem.mass_ratio = ratio;
        problem.at_rest = at_rest;
        const std::string state = at_rest ? "rest" : "moving";
        problem.column = fmt::format("{} {}{}", rows, ratio_text(ratio), at_rest ? " rest" : "");
        problem.series = fmt::format("{}-{}-{}-{}", form, family, ratio_text(ratio), state);
        problem.name = fmt::format("{}-{}-{}-{}-{}", form, family, rows, ratio_text(ratio), state);
        problem.make = [form, family, size, ratio, at_rest, seed = options.seed,
                        mu = options.friction] {
          return make_form(form,
                           {.family = family,
                            .size = size,
                            .mass_ratio = ratio,
                            .seed = seed,
                            .at_rest = at_rest},
                           mu);
        };
        problems.push_back(std::move(problem));
      }
    }
  }
}

void add_classic(const PeerProblemOptions& options, const std::string& family,
                 std::vector<PeerProblem>& problems) {
  for (int n : options.sizes) {
    if (family == "murty" || family == "fathi") {
      n = std::min(n, 20);  // exponential for some: 2^20 pivots are enough to see it
    }
    const std::string name = fmt::format("lcp-{}-{}", family, n);
    if (!problems.empty() && problems.back().name == name) {
      continue;
    }
    PeerProblem problem;
    problem.form = "lcp";
    problem.family = family;
    problem.column = std::to_string(n);
    problem.series = "lcp-" + family;
    problem.name = name;
    if (family == "murty") {
      problem.make = [n] { return make_murty(n); };
    } else if (family == "fathi") {
      problem.make = [n] { return make_fathi(n); };
    } else {
      const int rank = family == "psd" ? n : std::max(1, n / 2);
      problem.make = [n, rank, seed = options.seed] { return make_random_psd(n, rank, seed); };
    }
    problems.push_back(std::move(problem));
  }
}

bool is_problem(const std::filesystem::path& folder) {
  return std::filesystem::exists(folder / "problem.txt");
}

void add_folder(const std::filesystem::path& folder, std::vector<PeerProblem>& problems) {
  lcp::ProblemFolder read = lcp::read_problem_folder(folder);
  PeerProblem problem;
  problem.form = read.kind;
  problem.family = "folders";
  problem.name = folder.filename().string();
  problem.column = problem.name;
  problem.series = problem.name;
  problem.make = [made = std::move(read.problem)] { return made; };
  problems.push_back(std::move(problem));
}

void add_folders(const std::filesystem::path& given, std::vector<PeerProblem>& problems) {
  if (!std::filesystem::is_directory(given)) {
    throw std::runtime_error(given.string() + ": no such folder");
  }
  if (is_problem(given)) {
    add_folder(given, problems);
    return;
  }
  std::vector<std::filesystem::path> found;
  for (const auto& entry : std::filesystem::directory_iterator(given)) {
    if (entry.is_directory() && is_problem(entry.path())) {
      found.push_back(entry.path());
    }
  }
  std::sort(found.begin(), found.end());
  for (const std::filesystem::path& folder : found) {
    add_folder(folder, problems);
  }
}

void check(const PeerProblemOptions& options) {
  for (const std::string& form : options.forms) {
    if (form != "lcp" && form != "pyramid" && form != "box" && form != "cone") {
      throw std::invalid_argument("form: must be one of lcp, pyramid, box, cone; got " + form);
    }
  }
  for (const int n : options.sizes) {
    if (n < 1) {
      throw std::invalid_argument("size: must be >= 1, got " + std::to_string(n));
    }
  }
  for (const std::string& family : options.families) {
    const bool classic =
        family == "psd" || family == "psd-half" || family == "murty" || family == "fathi";
    if (!classic && !is_contact_family(family)) {
      throw std::invalid_argument("family: no family is called " + family);
    }
  }
}

}  // namespace

int family_contacts(const std::string& family, int size) {
  if (family == "tower4" || family == "tower8") {
    return size * (family == "tower4" ? 4 : 8);
  }
  if (family == "pyramid2d") {
    return 4 * size * size;
  }
  if (family == "pyramid3d") {
    return pyramid3d_contacts(size);
  }
  return family == "wall" ? wall_contacts(size) : size;
}

int family_size(const std::string& family, int contacts) {
  if (family == "spheres") {
    return contacts;
  }
  int size = 1;
  while (std::abs(family_contacts(family, size + 1) - contacts) <
         std::abs(family_contacts(family, size) - contacts)) {
    ++size;
  }
  return size;
}

std::vector<PeerProblem> peer_problems(const PeerProblemOptions& options) {
  check(options);
  PeerProblemOptions sorted = options;
  std::sort(sorted.sizes.begin(), sorted.sizes.end());
  std::vector<PeerProblem> problems;
  for (const std::string& form : sorted.forms) {
    for (const std::string& family : sorted.families) {
      if (is_contact_family(family)) {
        add_contacts(sorted, form, family, problems);
      } else if (form == "lcp") {
        add_classic(sorted, family, problems);
      }
    }
  }
  for (const std::filesystem::path& folder : sorted.folders) {
    add_folders(folder, problems);
  }
  return problems;
}

}  // namespace signorini::bench
