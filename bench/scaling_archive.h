#pragma once

#include "bench/scaling_row.h"
#include "tools/byte_archive.h"

namespace signorini::bench {

void visit_fields(auto& archive, tools::Reflects<ScalingRow> auto& row) {
  archive(row.scene, row.bodies, row.engine, row.accuracy, row.threads, row.steps, row.failure,
          row.is_wrong, row.counts, row.costs);
}

}  // namespace signorini::bench
