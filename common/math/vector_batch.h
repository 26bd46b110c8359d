// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/base/float_traps.h"
#include "common/base/random_batch.h"
#include "common/math/vec.h"

namespace treefarm {

/// Directions or points of many paths, coordinate by coordinate.
struct VectorBatch {
    alignas(64) std::array<float, kDrawBatch> x, y, z;

    Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
    void set(std::size_t i, const Vec3& v) {
        x[i] = v.x;
        y[i] = v.y;
        z[i] = v.z;
    }
};

/// How many of a batch are worked on where the first `count` are asked for. What the others hold is anything.
inline std::uint32_t whole_lanes(std::uint32_t count) {
    if constexpr (kTrapsFloats) return count;
    constexpr std::uint32_t kLanes = 8;
    return (count + kLanes - 1) / kLanes * kLanes;
}

}  // namespace treefarm
