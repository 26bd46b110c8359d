// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "common/base/random_batch.h"

namespace treefarm {

/// Places of a batch whose paths have ended, until others are set up there.
class EndedPaths {
  public:
    /// Begins a walk.
    void clear() {
        count_ = 0;
        enough_ = kEnough;
    }

    void add(std::uint8_t slot) { slots_[count_++] = slot; }

    /// Where enough have ended, or no path is left among the first `alive` of `walking`: follow(places) sets up others
    /// in the first of these places and returns how many, which are added. Returns how many walk now.
    template <class Follow>
    std::uint32_t replace(std::uint32_t alive, std::array<std::uint8_t, kDrawBatch>& walking, Follow& follow) {
        if (alive != 0 && count_ < enough_) return alive;
        const std::uint32_t others = follow(std::span<const std::uint8_t>(slots_.data(), count_));
        if (others < count_) enough_ = kDrawBatch + 1;  // no more are to come
        std::copy_n(slots_.begin(), others, walking.begin() + alive);
        count_ = 0;
        return alive + others;
    }

  private:
    /// Ended paths that are worth setting up others. With 8 and 16 a ray took as long.
    static constexpr std::uint32_t kEnough = kDrawBatch / 4;

    std::array<std::uint8_t, kDrawBatch> slots_;
    std::uint32_t count_ = 0, enough_ = kEnough;
};

}  // namespace treefarm
