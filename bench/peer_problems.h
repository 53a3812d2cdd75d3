#pragma once

#include <signorini/lcp/problem.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace signorini::bench {

/// A problem of the comparison, made when its turn comes.
struct PeerProblem {
  std::string name;  ///< "tower4-64-R1-moving"
  std::string form;  ///< "lcp", "mlcp", "pyramid", "box", "cone", "fc3d", "fc2d": one profile each
  std::string family;  ///< "tower4", "fathi", "folder": one table each, with the form
  std::string column;  ///< what tells it from the others of its table: "64 R1e3 rest"
  double mass_ratio = 1.0;
  bool at_rest = false;
  /// Problems of one series differ in size alone, growing: a solver that ran out of time is not
  /// asked for the larger ones.
  std::string series;
  std::function<lcp::Problem()> make;
};

/// Which problems.
struct PeerProblemOptions {
  std::vector<std::string> families;  ///< of contact_families.h, and "psd", "psd-half" (rank n/2),
                                      ///< "murty", "fathi"
  std::vector<std::string> forms = {"lcp"};  ///< of contacts: "lcp", "pyramid", "box", "cone"
  std::vector<int> sizes = {64, 256, 1000};  ///< rows of the frictionless problem, about
  std::vector<double> mass_ratios = {1.0};
  bool moving = true;
  bool at_rest = false;
  double friction = 0.5;  ///< mu of the forms with friction
  std::uint64_t seed = 1;
  std::vector<std::filesystem::path> folders;  ///< problem folders, or folders of them
};

/// The problems, smaller ones of a series first.
/// @throws std::invalid_argument naming an unknown family or form, or a size < 1;
/// std::runtime_error for a folder that does not exist.
[[nodiscard]] std::vector<PeerProblem> peer_problems(const PeerProblemOptions& options);

/// Contacts of a family of contact_families.h at a size.
[[nodiscard]] int family_contacts(const std::string& family, int size);
/// The size at which a family has about that many contacts.
[[nodiscard]] int family_size(const std::string& family, int contacts);

}  // namespace signorini::bench
