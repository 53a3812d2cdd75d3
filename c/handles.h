#pragma once

#include <signorini/c/signorini.h>
#include <signorini/lcp/problem.h>
#include <signorini/lcp/result.h>

/// What the opaque handles of lcp are. (C's names, hence not in our namespace.)

struct signorini_problem {
  signorini::lcp::Problem problem;
};

struct signorini_result {
  signorini::lcp::Result result;
};

namespace signorini::c {

/// The C struct of a certificate, of what a solve cost, of a status.
[[nodiscard]] signorini_certificate to_c(const lcp::Certificate& certificate);
[[nodiscard]] signorini_statistics to_c(const lcp::Statistics& statistics);
[[nodiscard]] signorini_status to_c(lcp::Status status);

}  // namespace signorini::c
