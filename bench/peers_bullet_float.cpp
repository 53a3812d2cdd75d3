// Bullet's MLCP solvers in single precision: those of peers_bullet.cpp, compiled into a program of
// their own, because both precisions' libraries have the same symbols.

#include "bench/peer.h"
#include "bench/sibling_program.h"

namespace signorini::bench {

void add_bullet_float_peers(std::vector<PeerEntry>& entries) {
  const std::filesystem::path program = sibling_program("signorini-bullet-float-peer");
  if (!std::filesystem::exists(program)) {
    return;
  }
  std::vector<PeerEntry> all;
  add_bullet_peers(all);
  for (PeerEntry& entry : all) {
    entry.name.insert(entry.name.find('-'), "-float");
    entry.library = "Bullet float";
    entry.may_be_regularised = false;  // 1 + 1e-10 is 1 in single precision
    entry.make = nullptr;
    entry.program = program;
    entries.push_back(std::move(entry));
  }
}

}  // namespace signorini::bench
