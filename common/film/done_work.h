// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "common/film/work_unit.h"

namespace treefarm {

/// The finished part of a pass: chunks of pixels, and ranges. It does not store the units, so the rest may be cut in
/// another way.
class DoneWork {
  public:
    DoneWork() : DoneWork(0, 0, 0) {}
    DoneWork(int width, int height, std::uint32_t chunks);

    /// Adds a unit that fits the film; no part of it may be finished yet.
    void add(const WorkUnit& unit);
    bool has(std::size_t pixel, std::uint32_t chunk) const {
        const std::size_t bit = chunk * pixels_ + pixel;
        return bits_[bit / 64] >> bit % 64 & 1;
    }
    /// Whether all chunks of a pixel are finished.
    bool whole(std::size_t pixel) const;
    /// Unfinished part of a unit: the unit itself, nothing, or pieces that cover it.
    std::vector<WorkUnit> left_of(const WorkUnit& unit) const;

    /// Whether a tile is inside the image.
    bool holds(const WorkUnit& tile) const {
        return tile.x0 < tile.x1 && tile.y0 < tile.y1 && tile.x1 <= width_ &&
               tile.y1 * std::uint64_t{width_} <= pixels_ && tile.chunk < chunks_;
    }
    bool empty() const { return weight_ == 0; }
    /// Sum of the weights of all units added.
    std::uint64_t weight() const { return weight_; }
    std::size_t pixel_count() const { return pixels_; }
    std::uint32_t chunks() const { return chunks_; }
    /// Number of estimates that a film stores for this work: one per whole pixel, otherwise one per finished chunk.
    std::size_t estimate_count() const;
    /// Whether add() can have produced this state for these numbers of pixels and chunks; `ends`: greatest end of
    /// ranges by kind.
    bool fits(std::size_t pixels, std::uint32_t chunks, const std::array<std::uint64_t, kUnitKinds>& ends) const;

    bool operator==(const DoneWork&) const = default;

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(width_, pixels_, chunks_, weight_, bits_, ranges_);
    }

  private:
    std::vector<WorkUnit> left_of_tile(const WorkUnit& tile) const;
    std::vector<WorkUnit> left_of_range(const WorkUnit& range) const;

    std::uint32_t width_ = 0, chunks_ = 0;
    std::uint64_t pixels_ = 0, weight_ = 0;
    std::vector<std::uint64_t> bits_;  ///< of chunk 0, pixel by pixel, then of chunk 1 ...
    /// End of each range by its beginning, by kind; ranges do not touch.
    std::array<std::map<std::uint64_t, std::uint64_t>, kUnitKinds> ranges_;
};

}  // namespace treefarm
