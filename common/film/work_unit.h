// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <vector>

namespace treefarm {

/// A film atom is (pass, pixel, aligned block of at most kBlockSamples samples): Welford in sample order inside a
/// block, blocks of a pixel reduced along a fixed binary tree. So a work unit may be any set of atoms, and any cut of
/// the image gives the same bits (docs/design/guiding.md, "film atoms").
inline constexpr std::uint32_t kBlockSamples = 64;

/// A rectangle of pixels, some aligned blocks of samples, one pass.
struct WorkUnit {
    std::uint32_t pass = 0;
    std::uint16_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< pixels [x0, x1) x [y0, y1)
    std::uint32_t chunk = 0;                       ///< which aligned run of PassPlan::blocks_per_unit blocks

    std::uint32_t pixel_count() const {
        return static_cast<std::uint32_t>(x1 - x0) * static_cast<std::uint32_t>(y1 - y0);
    }
    auto operator<=>(const WorkUnit&) const = default;
};

/// Everything of a pass of `chunks` runs of blocks: square tiles row by row, all runs of one before the next.
inline std::vector<WorkUnit> cut_pass(std::uint32_t pass, std::uint32_t chunks, int width, int height, int tile_size) {
    std::vector<WorkUnit> units;
    for (int y = 0; y < height; y += tile_size)
        for (int x = 0; x < width; x += tile_size)
            for (std::uint32_t chunk = 0; chunk < chunks; ++chunk)
                units.push_back({pass, static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                                 static_cast<std::uint16_t>(std::min(x + tile_size, width)),
                                 static_cast<std::uint16_t>(std::min(y + tile_size, height)), chunk});
    return units;
}

}  // namespace treefarm
