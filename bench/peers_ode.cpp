// ODE's Dantzig. Its header is internal, its functions are exported by libode: the declarations
// below are those of ODE 0.16.2 (ode/src/lcp.h, ode/src/util.h), checked at configure time.

#include "bench/peer.h"

#include <cstdarg>
#include <cstddef>
#include <ode/ode.h>

class dxWorldProcessMemArena;
class dxWorldProcessMemoryManager;
struct dxWorldProcessMemoryReserveInfo;
extern void dxSolveLCP(dxWorldProcessMemArena* arena, unsigned n, dReal* A, dReal* b_and_x,
                       dReal* w, unsigned unbounded, dReal* lo_and_hi, int* findex);
extern std::size_t dxEstimateSolveLCPMemoryReq(unsigned n, bool w_is_given);
extern dxWorldProcessMemArena* dxAllocateTemporaryWorldProcessMemArena(
    std::size_t bytes, const dxWorldProcessMemoryManager* manager,
    const dxWorldProcessMemoryReserveInfo* reserve);
extern void dxFreeTemporaryWorldProcessMemArena(dxWorldProcessMemArena* arena);

namespace signorini::bench {
namespace {

static_assert(sizeof(dReal) == sizeof(double), "ODE in double precision");

/// The first members of dxWorldProcessMemArena; what it allocates starts over at `begin`.
struct ArenaHead {
  void* current;
  void* begin;
};

// ODE's message handler is a plain function without an argument of ours.
bool lcp_error_seen = false;

void note_message(int number, const char* /*format*/, va_list /*arguments*/) {
  lcp_error_seen = lcp_error_seen || number == d_ERR_LCP;
}

class OdePeer : public Peer {
 public:
  OdePeer() { dSetMessageHandler(&note_message); }
  ~OdePeer() override {
    if (arena_ != nullptr) {
      dxFreeTemporaryWorldProcessMemArena(arena_);
    }
  }

  void load(const lcp::Problem& problem) override {
    n_ = static_cast<unsigned>(problem.size());
    const unsigned stride = n_ > 1 ? (n_ + 3) & ~3u : n_;
    const lcp::Matrix M = lcp::to_dense(problem.M);
    matrix_.assign(std::size_t{n_} * stride, 0.0);
    for (unsigned i = 0; i < n_; ++i) {
      for (unsigned j = 0; j < n_; ++j) {
        matrix_[std::size_t{i} * stride + j] = M(i, j);
      }
    }
    const RowBounds bounds = row_bounds(problem);
    for (unsigned i = 0; i < n_; ++i) {
      b_and_x_.insert(b_and_x_.end(), {-problem.q[i], 0.0});
      lo_and_hi_.insert(lo_and_hi_.end(), {bounds.lower[i], bounds.upper[i]});
    }
    findex_ = bounds.normal_row;
    arena_ = dxAllocateTemporaryWorldProcessMemArena(dxEstimateSolveLCPMemoryReq(n_, false),
                                                     nullptr, nullptr);
  }

  void rewind() override {
    work_matrix_ = matrix_;
    work_b_and_x_ = b_and_x_;
    work_lo_and_hi_ = lo_and_hi_;
    work_findex_ = findex_;
    lcp_error_seen = false;
    auto* head = reinterpret_cast<ArenaHead*>(arena_);
    head->current = head->begin;
  }

  void solve(PeerAnswer& answer) override {
    dxSolveLCP(arena_, n_, work_matrix_.data(), work_b_and_x_.data(), nullptr, 0,
               work_lo_and_hi_.data(), work_findex_.data());
    answer.claim = lcp_error_seen ? Claim::kFailed : Claim::kSolved;
    answer.said = lcp_error_seen ? "LCP internal error" : "";
    answer.z.resize(n_);
    for (unsigned i = 0; i < n_; ++i) {
      answer.z[i] = work_b_and_x_[2 * i + 1];
    }
  }

 private:
  unsigned n_ = 0;
  dxWorldProcessMemArena* arena_ = nullptr;
  std::vector<double> matrix_, work_matrix_;
  std::vector<double> b_and_x_, work_b_and_x_;
  std::vector<double> lo_and_hi_, work_lo_and_hi_;
  std::vector<int> findex_, work_findex_;
};

}  // namespace

void add_ode_peers(std::vector<PeerEntry>& entries) {
  PeerEntry entry;
  entry.library = "ODE";
  entry.name = "ode-dantzig";
  entry.may_be_regularised = true;
  entry.refuses = &refuses_all_but_symmetric_boxes;
  entry.make = [](const PeerSettings&) { return std::make_unique<OdePeer>(); };
  entries.push_back(entry);
}

}  // namespace signorini::bench
