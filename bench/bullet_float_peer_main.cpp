// signorini-bullet-float-peer NAME: one of Bullet's solvers in single precision on the PeerTask on
// its standard input. Prints what measure_peer() returns, and nothing but it; what went wrong with
// exit code 1.

#include "bench/peer_task.h"

#include <cstdio>
#include <exception>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <unistd.h>

namespace {

using namespace signorini::bench;

PeerEntry solver_called(const std::string& name) {
  std::vector<PeerEntry> all;
  add_bullet_peers(all);
  for (PeerEntry& entry : all) {
    if (name == "bullet-float" + entry.name.substr(entry.name.find('-'))) {
      return entry;
    }
  }
  throw std::invalid_argument("no solver is called " + name);
}

std::string run(const std::string& name) {
  const PeerEntry entry = solver_called(name);
  const std::string input{std::istreambuf_iterator<char>(std::cin), {}};
  const auto task = signorini::tools::from_bytes<PeerTask>(input);
  const signorini::lcp::Problem problem = problem_of(task);
  return measure_peer(entry, problem, problem, task.settings, task.limits, [] {});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: signorini-bullet-float-peer NAME < TASK\n", stderr);
    return 64;
  }
  // Bullet prints warnings: they must not get between the bytes.
  std::FILE* answer = ::fdopen(::dup(STDOUT_FILENO), "w");
  if (answer == nullptr || std::freopen("/dev/null", "w", stdout) == nullptr) {
    return 70;
  }
  int code = 0;
  std::string bytes;
  try {
    bytes = run(argv[1]);
  } catch (const std::exception& error) {
    bytes = error.what();
    code = 1;
  }
  const bool is_written = std::fwrite(bytes.data(), 1, bytes.size(), answer) == bytes.size();
  return std::fclose(answer) == 0 && is_written ? code : 70;
}
