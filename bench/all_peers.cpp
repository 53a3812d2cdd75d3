#include "bench/peer.h"

namespace signorini::bench {

std::vector<PeerEntry> all_peers() {
  std::vector<PeerEntry> entries;
  add_signorini_peers(entries);
#ifdef SIGNORINI_PEER_BULLET
  add_bullet_peers(entries);
  add_bullet_float_peers(entries);
#endif
#ifdef SIGNORINI_PEER_ODE
  add_ode_peers(entries);
#endif
#ifdef SIGNORINI_PEER_DART
  add_dart_peers(entries);
#endif
#ifdef SIGNORINI_PEER_SICONOS
  add_siconos_peers(entries);
#endif
  return entries;
}

std::vector<AbsentPeer> absent_peers() {
  std::vector<AbsentPeer> absent;
#ifndef SIGNORINI_PEER_BULLET
  absent.push_back({"Bullet", "libbullet-dev"});
#else
  std::vector<PeerEntry> single;
  add_bullet_float_peers(single);
  if (single.empty()) {
    absent.push_back({"Bullet float", "libbullet-dev"});
  }
#endif
#ifndef SIGNORINI_PEER_ODE
  absent.push_back({"ODE", "libode-dev"});
#endif
#ifndef SIGNORINI_PEER_DART
  absent.push_back({"DART", "libdart-dev"});
#endif
#ifndef SIGNORINI_PEER_SICONOS
  absent.push_back({"Siconos", "libsiconos-numerics-dev"});
#endif
  return absent;
}

}  // namespace signorini::bench
