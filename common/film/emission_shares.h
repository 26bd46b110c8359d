// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "common/film/trace_stats.h"

namespace treefarm {

/// How often light paths start from each emitter, by what those of earlier passes brought to the image: noise is least
/// where an emitter is chosen in proportion to the root of its paths' second moment (docs/design/transport.md). Exact
/// sums make it, frozen during a pass, so it is the same whatever the farm was.

/// Factor of each entry's probability by power, before all are scaled to sum to one; empty where nothing is known, or
/// there is no choice.
std::vector<float> emission_emphasis(const EmissionSums& sums);

/// Fewest emitters from which at least half of the light paths started; 0 where nobody counted.
std::size_t emitters_of_half(const EmissionSums& sums);

}  // namespace treefarm
