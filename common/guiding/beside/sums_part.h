// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/statistics/cell_sums.h"

namespace treefarm {

/// Sums of a range of distributions and cells, those of one of several guides. `shape`: of the part, without visits;
/// sums per region, of emitters and direct light, belong to the part that begins at 0.
CellSums sums_part(const CellSums& sums, const SumsShape& shape, std::uint32_t first_distribution,
                   std::uint32_t first_cell);

}  // namespace treefarm
