// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"

namespace treefarm {

/// Right-handed orthonormal frame around a unit normal n: local z is n.
struct Frame {
    Vec3 s, t, n;

    /// Branch-free construction that keeps full precision at n.z -> -1 (Duff et al. 2017, "Building an orthonormal
    /// basis, revisited").
    explicit Frame(const Vec3& normal) : n(normal) {
        const float sign = std::copysign(1.0f, n.z);
        const float a = -1.0f / (sign + n.z);
        const float b = n.x * n.y * a;
        s = {1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x};
        t = {b, sign + n.y * n.y * a, -n.y};
    }

    Vec3 to_local(const Vec3& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
    Vec3 to_world(const Vec3& v) const { return s * v.x + t * v.y + n * v.z; }
};

}  // namespace treefarm
