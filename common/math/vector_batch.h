// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/base/float_traps.h"
#include "common/base/random_batch.h"
#include "common/math/vec.h"

namespace treefarm {

/// Directions or points of a batch of paths, by coordinate.
struct VectorBatch {
    alignas(64) std::array<float, kDrawBatch> x, y, z;

    Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
    void set(std::size_t i, const Vec3& v) {
        x[i] = v.x;
        y[i] = v.y;
        z[i] = v.z;
    }
};

/// `count` rounded up to whole vector registers: the entries that are computed. Those from `count` on are undefined.
inline std::uint32_t whole_lanes(std::uint32_t count) {
    if constexpr (kTrapsFloats) return count;
    constexpr std::uint32_t kLanes = 8;
    return (count + kLanes - 1) / kLanes * kLanes;
}

}  // namespace treefarm
