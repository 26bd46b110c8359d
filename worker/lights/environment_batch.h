// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cassert>

#include "common/base/random.h"
#include "common/base/random_batch.h"
#include "common/math/vec.h"

namespace treefarm {

/// Bilinear footprint between four texel centres: their columns and rows, and the fractions between them.
struct TexelFootprint {
    int x0, x1, y0, y1;
    float fx, fy;
};

/// A direction drawn from an environment map.
struct EnvironmentSample {
    Vec3 direction;  ///< unit
    TexelFootprint footprint;
    float sine;  ///< of the angle from the pole
};

/// Directions to be drawn together (EnvironmentMap::sample): memory latencies overlap, and arithmetic is vector code.
/// Each equals, to the bit, the direction drawn alone.
class EnvironmentBatch {
  public:
    static constexpr std::uint32_t kMost = kDrawBatch;

    void clear() { count_ = 0; }
    /// Adds a direction of this part with these numbers, as for EnvironmentMap::sample(); returns its index.
    std::uint32_t add(int part, const Draw& random) {
        assert(count_ < kMost);
        part_[count_] = part;
        row_bits_[count_] = random[1];
        column_bits_[count_] = random[2];
        tent_bits_[count_] = random[3];
        return count_++;
    }

    EnvironmentSample operator[](std::uint32_t i) const { return {direction(i), footprint(i), sine_[i]}; }
    Vec3 direction(std::uint32_t i) const { return {dx_[i], dy_[i], dz_[i]}; }
    TexelFootprint footprint(std::uint32_t i) const { return {x0_[i], x1_[i], y0_[i], y1_[i], fx_[i], fy_[i]}; }

  private:
    friend class EnvironmentMap;
    template <class T>
    using Lanes = std::array<T, kMost>;

    std::uint32_t count_ = 0;
    alignas(64) Lanes<std::int32_t> part_;
    Lanes<std::uint32_t> row_bits_, column_bits_;
    // Zero-initialised, since vector code runs beyond the last lane.
    Lanes<std::uint32_t> tent_bits_{};
    Lanes<std::int32_t> row_{}, column_{};
    Lanes<std::uint32_t> low_, high_;  ///< range of columns from the look-up table
    Lanes<float> dx_, dy_, dz_, fx_, fy_, sine_;
    Lanes<std::int32_t> x0_, x1_, y0_, y1_;
};

}  // namespace treefarm
