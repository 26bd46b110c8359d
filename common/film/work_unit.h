// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <vector>

namespace treefarm {

/// Samples of a film atom. An atom is (pass, pixel, aligned block of at most kBlockSamples samples): Welford's sums in
/// sample order inside a block, blocks of a pixel reduced along a fixed binary tree. So any cut of the image into tiles
/// gives the same bits (docs/design/guiding.md, "film atoms").
inline constexpr std::uint32_t kBlockSamples = 64;

/// Light paths of a range, before ranges shrink towards the end of a pass.
inline constexpr std::uint32_t kRangePaths = 1u << 14;

/// Kind of a work unit. On the wire: append only.
enum class UnitKind : std::uint8_t {
    tile,         ///< a rectangle of pixels, some aligned blocks of samples
    light_paths,  ///< light paths of a pass; contributions are summed exactly, so any cut gives the same bits
    chains,       ///< Markov chains of a pass; a chain is always done by one worker
};
inline constexpr std::uint8_t kUnitKinds = 3;

/// A piece of a pass.
struct WorkUnit {
    std::uint32_t pass = 0;
    std::uint16_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< of a tile: pixels [x0, x1) x [y0, y1)
    std::uint32_t chunk = 0;  ///< of a tile: index of an aligned run of PassPlan::blocks_per_unit blocks
    UnitKind kind = UnitKind::tile;
    std::uint64_t first = 0;  ///< of a range: [first, first + count)
    std::uint32_t count = 0;

    /// Number of pixels of a tile; 0 for ranges.
    std::uint32_t pixel_count() const {
        return static_cast<std::uint32_t>(x1 - x0) * static_cast<std::uint32_t>(y1 - y0);
    }
    auto operator<=>(const WorkUnit&) const = default;  // NOLINT(modernize-use-nullptr): its own 0
};

/// Amount of work: pixels of a tile, paths or chains of a range.
std::uint64_t weight(const WorkUnit& unit);

/// A unit cut into smaller pieces: a tile into quarters, a range into halves. One piece if it cannot be cut.
std::vector<WorkUnit> halve(const WorkUnit& unit);

/// Tiles of a pass with `chunks` runs of blocks: squares row by row, all chunks of a square before the next square.
std::vector<WorkUnit> cut_tiles(std::uint32_t pass, std::uint32_t chunks, int width, int height, int tile_size);

/// Ranges of at most `most` that cover [0, count).
std::vector<WorkUnit> cut_range(std::uint32_t pass, UnitKind kind, std::uint64_t count, std::uint32_t most);

}  // namespace treefarm
