// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "common/base/random_batch.h"

namespace treefarm {

/// Slots of a batch whose paths have ended and that are not refilled yet.
class EndedPaths {
  public:
    /// Clears the slots, at the start of a walk.
    void clear() {
        count_ = 0;
        enough_ = kEnough;
    }

    void add(std::uint8_t slot) { slots_[count_++] = slot; }

    /// Refills ended slots, once there are enough or none of the first `alive` of `walking` is left: follow(slots) sets
    /// up new paths in the first of these slots and returns their number. Returns how many paths walk now.
    template <class Follow>
    std::uint32_t replace(std::uint32_t alive, std::array<std::uint8_t, kDrawBatch>& walking, Follow& follow) {
        if (alive != 0 && count_ < enough_) return alive;
        const std::uint32_t others = follow(std::span<const std::uint8_t>(slots_.data(), count_));
        if (others < count_) enough_ = kDrawBatch + 1;  // no more paths will come
        std::copy_n(slots_.begin(), others, walking.begin() + alive);
        count_ = 0;
        return alive + others;
    }

  private:
    /// Number of ended paths that makes a refill efficient. With 8 and 16 the time per ray was equal.
    static constexpr std::uint32_t kEnough = kDrawBatch / 4;

    std::array<std::uint8_t, kDrawBatch> slots_;
    std::uint32_t count_ = 0, enough_ = kEnough;
};

}  // namespace treefarm
