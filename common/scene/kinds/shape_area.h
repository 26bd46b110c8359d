// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "common/scene/kinds/shapes.h"

namespace treefarm {

/// Area of a shape's own surface, in its group's space, in double. Each kind needs an overload.
inline double area(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const Imath::V3d a(mesh.positions[mesh.indices[i]]), b(mesh.positions[mesh.indices[i + 1]]),
            c(mesh.positions[mesh.indices[i + 2]]);
        const Imath::V3d n = (b - a).cross(c - a);
        sum += 0.5 * std::sqrt(n.dot(n));
    }
    return sum;
}

inline double area(const Sphere& sphere) {
    return 4 * M_PI * double(sphere.radius) * double(sphere.radius);
}

inline double area(const Disk& disk) {
    const Imath::V3d n = Imath::V3d(disk.half_u).cross(Imath::V3d(disk.half_v));
    return M_PI * std::sqrt(n.dot(n));
}

inline double area(const Cylinder& cylinder) {
    const Imath::V3d axis(cylinder.p1 - cylinder.p0);
    return 2 * M_PI * double(cylinder.radius) * std::sqrt(axis.dot(axis));
}

inline double area(const Instance&) {
    return 0;
}

inline double area_of(const ShapeKind& kind) {
    return std::visit([](const auto& shape) { return area(shape); }, kind);
}

}  // namespace treefarm
