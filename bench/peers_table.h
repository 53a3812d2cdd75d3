#pragma once

#include "bench/peers_study.h"
#include "bench/performance_profile.h"

#include <string>
#include <vector>

namespace signorini::bench {

/// All runs, one a line. Seconds that were not measured and counters that a solver does not have
/// are empty; residuals of an answer that does not exist are "nan".
[[nodiscard]] std::string peers_csv(const PeersResult& result);

/// One table a form and family: a row a solver, a column a problem, in a cell the time of the
/// fastest solve or the verdict's mark. Solvers that refused all of a table's problems are left
/// out.
[[nodiscard]] std::string peers_text(const PeersResult& result);

/// The same in Markdown, the fastest of a column in bold, after a page on what was measured and
/// how.
/// @param remarks lines to print first: machine, build, options
[[nodiscard]] std::string peers_markdown(const PeersResult& result,
                                         const std::vector<std::string>& remarks);

/// What the marks mean, one line each.
[[nodiscard]] std::vector<std::string> peers_legend();

/// The performance profiles of the runs, one panel a form.
[[nodiscard]] std::vector<ProfilePanel> peers_profiles(const PeersResult& result);

/// "88us", "6.9ms", ".44s", "12s".
[[nodiscard]] std::string short_time(double seconds);

}  // namespace signorini::bench
