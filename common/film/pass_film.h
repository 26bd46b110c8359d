// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/base/bytes.h"
#include "common/film/done_work.h"
#include "common/film/pixel_estimate.h"
#include "common/film/work_unit.h"

namespace treefarm {

/// Reduces the estimates of consecutive aligned blocks along a fixed binary tree over the block index: the left child
/// has the largest power of two below the count. So a run of 2^j aligned blocks is always one subtree.
PixelEstimate reduce_blocks(std::span<const PixelEstimate> blocks);

/// Film of one pass. Work units may come in any order; the result has the same bits.
class PassFilm {
  public:
    PassFilm(int width, int height, std::uint32_t chunks);

    /// Adds the pixels of a unit, row by row. Each pixel and chunk must come exactly once (guaranteed by the ledger).
    void add(const WorkUnit& unit, std::span<const PixelEstimate> pixels);

    /// The work received, which must equal `done`: one estimate per whole pixel, otherwise one per chunk.
    Bytes encode(const DoneWork& done) const;
    /// Restores the result of encode() into an empty film. Throws FormatError, without any change, if it has another
    /// size.
    void restore(const DoneWork& done, std::span<const std::uint8_t> bytes);

    bool complete() const { return missing_ == 0; }
    int width() const { return width_; }
    int height() const { return height_; }
    /// The pixels row by row from the top. Valid once complete; before, pixels with missing chunks are empty.
    const std::vector<PixelEstimate>& pixels() const { return pixels_; }
    /// Moves pixels() out, which saves a copy of a large image; nothing can be added afterwards.
    std::vector<PixelEstimate> take_pixels() { return std::exchange(pixels_, {}); }

  private:
    int width_, height_;
    std::uint32_t chunks_;
    std::uint64_t missing_;  ///< pixel-chunks not yet received
    std::vector<PixelEstimate> pixels_;

    struct Pending {
        std::vector<PixelEstimate> chunks;
        std::uint32_t arrived = 0;
    };
    std::unordered_map<std::uint32_t, Pending> pending_;  ///< pixels that lack chunks, by index
};

}  // namespace treefarm
