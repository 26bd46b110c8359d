#pragma once

#include <array>

#include "common/base/random_batch.h"
#include "common/math/warp.h"

namespace treefarm {

/// Directions of many paths, coordinate by coordinate.
struct DirectionBatch {
    alignas(64) std::array<float, kDrawBatch> x, y, z;

    Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
};

/// square_to_cosine_hemisphere() of words 2 and 3 of the first `count` draws: the same bits, by vector code.
inline void cosine_hemisphere_batch(const DrawBatch& draws, std::uint32_t count, DirectionBatch& out) {
    constexpr std::uint32_t kLanes = 8;
    for (std::uint32_t i = 0; i < (count + kLanes - 1) / kLanes * kLanes; ++i) {
        const Vec3 d = square_to_cosine_hemisphere({to_unit(draws.word[2][i]), to_unit(draws.word[3][i])});
        out.x[i] = d.x;
        out.y[i] = d.y;
        out.z[i] = d.z;
    }
}

}  // namespace treefarm
