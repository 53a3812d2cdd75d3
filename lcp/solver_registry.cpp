#include <signorini/lcp/alart_curnier.h>
#include <signorini/lcp/apgd.h>
#include <signorini/lcp/auto_solver.h>
#include <signorini/lcp/block_pivoting.h>
#include <signorini/lcp/cone_interior_point.h>
#include <signorini/lcp/cone_smoothing.h>
#include <signorini/lcp/dantzig.h>
#include <signorini/lcp/frictionless.h>
#include <signorini/lcp/interior_point.h>
#include <signorini/lcp/lemke.h>
#include <signorini/lcp/nncg.h>
#include <signorini/lcp/nsgs.h>
#include <signorini/lcp/pgs.h>
#include <signorini/lcp/psor.h>
#include <signorini/lcp/solver.h>
#include <signorini/lcp/sticking.h>
#include <signorini/lcp/structured_lemke.h>
#include <signorini/lcp/symmetric_pgs.h>

#include <array>
#include <stdexcept>
#include <string>

#ifdef SIGNORINI_HAS_GMP
#include <signorini/lcp/exact_lemke.h>
#endif

namespace signorini::lcp {
namespace {

struct Entry {
  std::string_view name;
  std::unique_ptr<Solver> (*make)(const SolverSettings&);
};

template <typename Made, typename Settings>
std::unique_ptr<Solver> make(const SolverSettings& settings) {
  Settings own;
  static_cast<SolverSettings&>(own) = settings;
  return std::make_unique<Made>(own);
}

template <typename Made, typename Settings>
std::unique_ptr<Solver> make_float(const SolverSettings& settings) {
  Settings own;
  static_cast<SolverSettings&>(own) = settings;
  own.precision = Precision::kFloat;
  return std::make_unique<Made>(own);
}

constexpr std::array kEntries = {
    Entry{"auto", &make<AutoSolver, AutoSettings>},
    Entry{"lemke", &make<Lemke, LemkeSettings>},
    Entry{"structured-lemke", &make<StructuredLemke, StructuredLemkeSettings>},
    Entry{"interior-point", &make<InteriorPoint, InteriorPointSettings>},
    Entry{"apgd", &make<Apgd, ApgdSettings>},
    Entry{"dantzig", &make<Dantzig, DantzigSettings>},
    Entry{"block-pivoting", &make<BlockPivoting, BlockPivotingSettings>},
    Entry{"cone-interior-point", &make<ConeInteriorPoint, ConeInteriorPointSettings>},
    Entry{"cone-smoothing", &make<ConeSmoothing, ConeSmoothingSettings>},
    Entry{"frictionless", &make<Frictionless, FrictionlessSettings>},
    Entry{"sticking", &make<Sticking, StickingSettings>},
    Entry{"alart-curnier", &make<AlartCurnier, AlartCurnierSettings>},
    Entry{"nsgs", &make<Nsgs, NsgsSettings>},
    Entry{"pgs", &make<Pgs, PgsSettings>},
    Entry{"pgs-float", &make_float<Pgs, PgsSettings>},
    Entry{"symmetric-pgs", &make<SymmetricPgs, SymmetricPgsSettings>},
    Entry{"symmetric-pgs-float", &make_float<SymmetricPgs, SymmetricPgsSettings>},
    Entry{"psor", &make<Psor, PsorSettings>},
    Entry{"psor-float", &make_float<Psor, PsorSettings>},
    Entry{"nncg", &make<Nncg, NncgSettings>},
    Entry{"nncg-float", &make_float<Nncg, NncgSettings>},
#ifdef SIGNORINI_HAS_GMP
    Entry{"exact", &make<ExactLemke, ExactLemkeSettings>},
#endif
};

constexpr auto kNames = [] {
  std::array<std::string_view, kEntries.size()> names;
  for (std::size_t i = 0; i < names.size(); ++i) {
    names[i] = kEntries[i].name;
  }
  return names;
}();

}  // namespace

std::span<const std::string_view> solver_names() {
  return kNames;
}

std::unique_ptr<Solver> make_solver(std::string_view name, const SolverSettings& settings) {
  std::string known;
  for (const Entry& entry : kEntries) {
    if (entry.name == name) {
      return entry.make(settings);
    }
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw std::invalid_argument("make_solver: no solver is called \"" + std::string(name) +
                              "\"; known: " + known);
}

}  // namespace signorini::lcp
