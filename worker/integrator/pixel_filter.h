#pragma once

#include <cstdint>
#include <vector>

#include "common/base/random.h"
#include "common/scene/scene.h"

namespace treefarm {

/// Draws sub-pixel offsets from the film's reconstruction filter: every sample then weighs 1 and touches one pixel.
class FilterSampler {
  public:
    explicit FilterSampler(const Film& film);

    /// Offset from the pixel's centre along one axis, in pixels, distributed as the filter.
    float sample(std::uint32_t random) const;

  private:
    static constexpr std::uint32_t kCells = 512;

    PixelFilter filter_;
    float radius_;
    /// Gaussian: probability (times 2^31) of |x| below the left edge of each of kCells equal cells of [0, radius].
    std::vector<std::uint32_t> cumulative_;
};

}  // namespace treefarm
