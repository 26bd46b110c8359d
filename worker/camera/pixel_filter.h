// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/random.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// Sampler of sub-pixel offsets from the reconstruction filter: every sample contributes to one pixel with weight 1. A
/// filter with negative lobes is sampled by its absolute value and weighted by its sign.
class FilterSampler {
  public:
    explicit FilterSampler(const Film& film);

    /// Offset from the pixel's centre along one axis, in pixels, distributed as the filter.
    float sample(std::uint32_t random) const;
    /// Weight of the offset that sample() returns for this number; with it the filter's integral is 1.
    float weight(std::uint32_t random) const;
    /// Value of the filter along one axis, normalised to integral 1, per pixel; without negative lobes it is the
    /// density of sample().
    float value(float offset) const;
    /// Filter radius in pixels: beyond it the filter is 0.
    float radius() const { return radius_; }

  private:
    static constexpr std::uint32_t kBins = 512;

    std::uint32_t bin_of(std::uint32_t bits) const;

    PixelFilter filter_;
    float radius_;
    float weight_ = 1.0f;
    std::vector<bool> negative_;  ///< bins in negative lobes
    /// For filters other than box and tent: probability, times 2^31, of |x| below the left edge of each of kBins equal
    /// bins of [0, radius].
    std::vector<std::uint32_t> cumulative_;
};

}  // namespace treefarm
