// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/beside/sums_part.h"

#include <algorithm>

namespace treefarm {

CellSums sums_part(const CellSums& sums, const SumsShape& shape, std::uint32_t first_distribution,
                   std::uint32_t first_cell) {
    CellSums part(sums.pass(), shape);
    for (std::uint32_t c = 0; c < shape.cells; ++c)
        part.add_quanta(c, sums.cells()[first_cell + c]);
    for (std::uint32_t d = 0; d < shape.regions + shape.views; ++d) {
        part.add_count(d, sums.counts()[first_distribution + d]);
        if (!shape.with_mixture) continue;
        const auto bins = sums.mixture(first_distribution + d);
        for (std::uint8_t b = 0; b < kMixtureBins; ++b)
            part.add_mixture(d, b, bins[b]);
    }
    for (std::uint32_t r = 0; r < shape.regions; ++r) {
        if (shape.with_lights)
            for (int cluster = 0; cluster < kLightClusters; ++cluster)
                part.add_light(r, cluster, sums.lights(r)[static_cast<std::size_t>(cluster)]);
        if (shape.with_next_event) {
            NextEventSums direct;
            std::copy_n(sums.next_event(r).begin(), kNextEventSums, direct.begin());
            part.add_next_event(r, direct);
        }
    }
    return part;
}

}  // namespace treefarm
