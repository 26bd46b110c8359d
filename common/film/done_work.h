// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "common/film/work_unit.h"

namespace treefarm {

/// The part of a pass that is done: which chunks of which pixels, and which ranges. It does not tell how they were cut
/// into units, so what is left may be cut otherwise.
class DoneWork {
  public:
    DoneWork() : DoneWork(0, 0, 0) {}
    DoneWork(int width, int height, std::uint32_t chunks);

    /// Adds a unit that fits the film. Nothing of it may be done.
    void add(const WorkUnit& unit);
    bool has(std::size_t pixel, std::uint32_t chunk) const {
        const std::size_t bit = chunk * pixels_ + pixel;
        return bits_[bit / 64] >> bit % 64 & 1;
    }
    /// Whether all chunks of a pixel are done.
    bool whole(std::size_t pixel) const;
    /// What is left of a unit: the unit itself, none, or pieces that cover it.
    std::vector<WorkUnit> left_of(const WorkUnit& unit) const;

    /// Whether a tile lies in the image.
    bool holds(const WorkUnit& tile) const {
        return tile.x0 < tile.x1 && tile.y0 < tile.y1 && tile.x1 <= width_ &&
               tile.y1 * std::uint64_t{width_} <= pixels_ && tile.chunk < chunks_;
    }
    bool empty() const { return weight_ == 0; }
    /// Sum of the weights of what was added.
    std::uint64_t weight() const { return weight_; }
    std::size_t pixel_count() const { return pixels_; }
    std::uint32_t chunks() const { return chunks_; }
    /// Estimates that a film of it holds: of a whole pixel one, otherwise one per chunk that is done.
    std::size_t estimate_count() const;
    /// Whether it is what add() can have made for so many pixels and chunks, `ends`: of ranges by kind.
    bool fits(std::size_t pixels, std::uint32_t chunks, const std::array<std::uint64_t, kUnitKinds>& ends) const;

    bool operator==(const DoneWork&) const = default;

    /// Lists what it remembers, for a checkpoint.
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
    /// Ends of ranges by where they begin, by kind: none touches another.
    std::array<std::map<std::uint64_t, std::uint64_t>, kUnitKinds> ranges_;
};

}  // namespace treefarm
