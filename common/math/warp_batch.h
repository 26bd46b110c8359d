// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/math/direction_map.h"
#include "common/math/vector_batch.h"
#include "common/math/warp.h"

namespace treefarm {

/// direction_to_code() of the first `count` directions.
inline void direction_to_code_batch(const VectorBatch& from, std::uint32_t count,
                                    std::array<std::uint32_t, kDrawBatch>& codes) {
    for (std::uint32_t i = 0; i < whole_lanes(count); ++i)
        codes[i] = direction_to_code({from.x[i], from.y[i], from.z[i]});
}

/// square_to_direction() of the first `count` points.
inline void square_to_direction_batch(const std::array<float, kDrawBatch>& x, const std::array<float, kDrawBatch>& y,
                                      std::uint32_t count, VectorBatch& out) {
    for (std::uint32_t i = 0; i < whole_lanes(count); ++i) {
        const Vec3 d = square_to_direction({x[i], y[i]});
        out.x[i] = d.x;
        out.y[i] = d.y;
        out.z[i] = d.z;
    }
}

/// square_to_cosine_hemisphere() of words 2 and 3 of the first `count` draws, with the same bits, as vector code.
inline void cosine_hemisphere_batch(const DrawBatch& draws, std::uint32_t count, VectorBatch& out) {
    for (std::uint32_t i = 0; i < whole_lanes(count); ++i) {
        const Vec3 d = square_to_cosine_hemisphere({to_unit(draws.word[2][i]), to_unit(draws.word[3][i])});
        out.x[i] = d.x;
        out.y[i] = d.y;
        out.z[i] = d.z;
    }
}

}  // namespace treefarm
