// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/random.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// Draws sub-pixel offsets from the film's reconstruction filter: every sample then touches one pixel, and
/// weighs 1. A filter with negative lobes is drawn by its absolute value, and weighs by its sign.
class FilterSampler {
  public:
    explicit FilterSampler(const Film& film);

    /// Offset from the pixel's centre along one axis, in pixels, distributed as the filter.
    float sample(std::uint32_t random) const;
    /// Weight of the offset that sample() draws by this number, so that the filter's integral is 1.
    float weight(std::uint32_t random) const;
    /// The filter along one axis at this offset: of integral 1, and where it has no negative lobes the density of
    /// sample(), per pixel.
    float value(float offset) const;
    /// Beyond it, in pixels, the filter is 0.
    float radius() const { return radius_; }

  private:
    static constexpr std::uint32_t kBins = 512;

    std::uint32_t bin_of(std::uint32_t bits) const;

    PixelFilter filter_;
    float radius_;
    float weight_ = 1.0f;
    std::vector<bool> negative_;  ///< where bins lie in negative lobes
    /// Neither box nor tent: probability (times 2^31) of |x| below the left edge of each of kBins equal bins of [0,
    /// radius].
    std::vector<std::uint32_t> cumulative_;
};

}  // namespace treefarm
