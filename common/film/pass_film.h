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

/// Reduces the estimates of consecutive aligned blocks along the fixed binary tree over the block index: the left child
/// takes the largest power of two below the count. A run of 2^j aligned blocks is always one subtree.
PixelEstimate reduce_blocks(std::span<const PixelEstimate> blocks);

/// The film of one pass: takes work units in any order and gives the same bits.
class PassFilm {
  public:
    PassFilm(int width, int height, std::uint32_t chunks);

    /// Adds the pixels of a unit, row by row. Each pixel and chunk must come exactly once (the ledger sees to that).
    void add(const WorkUnit& unit, std::span<const PixelEstimate> pixels);

    /// What has come, which is what `done` says: of each whole pixel its estimate, of others those of their chunks.
    Bytes encode(const DoneWork& done) const;
    /// Takes what encode() gave into a film that nothing was added to. Throws FormatError where it is of another size;
    /// nothing is changed then.
    void restore(const DoneWork& done, std::span<const std::uint8_t> bytes);

    bool complete() const { return missing_ == 0; }
    int width() const { return width_; }
    int height() const { return height_; }
    /// The pixels row by row from the top. Valid once complete; before, those with missing chunks are empty.
    const std::vector<PixelEstimate>& pixels() const { return pixels_; }
    /// pixels(), moved out: the film of a large image is not copied. Nothing can be added any more.
    std::vector<PixelEstimate> take_pixels() { return std::exchange(pixels_, {}); }

  private:
    int width_, height_;
    std::uint32_t chunks_;
    std::uint64_t missing_;  ///< pixel-chunks still to come
    std::vector<PixelEstimate> pixels_;

    struct Pending {
        std::vector<PixelEstimate> chunks;
        std::uint32_t arrived = 0;
    };
    std::unordered_map<std::uint32_t, Pending> pending_;  ///< by pixel: those not yet whole
};

}  // namespace treefarm
