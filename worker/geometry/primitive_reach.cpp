// SPDX-License-Identifier: Apache-2.0
#include "worker/geometry/primitive_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "worker/geometry/placement.h"

namespace treefarm {
namespace {

using Imath::V3d;
using Corners = std::array<V3d, 3>;

Corners corners_of(const Mesh& mesh, std::uint32_t primitive, const Placement* placement) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) {
        const V3d local(mesh.positions[mesh.indices[3 * std::size_t(primitive) + i]]);
        corners[i] = placement ? placement->point_to_world(local) : local;
    }
    return corners;
}

double from_segment(const V3d& p, const V3d& a, const V3d& b) {
    const V3d along = b - a;
    const double length2 = along.dot(along);
    const double t = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
    return (p - a - along * t).length();
}

/// Distance of a point from a triangle: from its plane if the point projects into the triangle, else from the nearest
/// edge.
double from_triangle(const V3d& p, const Corners& c, double within) {
    // The bounding box alone rejects nearly all queries.
    for (int i = 0; i < 3; ++i) {
        const double low = std::min({c[0][i], c[1][i], c[2][i]}), high = std::max({c[0][i], c[1][i], c[2][i]});
        if (low - p[i] > within || p[i] - high > within) return std::numeric_limits<double>::infinity();
    }
    const V3d n = (c[1] - c[0]).cross(c[2] - c[0]);
    double nearest = std::numeric_limits<double>::infinity();
    bool above = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const V3d &a = c[i], &b = c[(i + 1) % 3];
        above &= (b - a).cross(p - a).dot(n) >= 0;
        nearest = std::min(nearest, from_segment(p, a, b));
    }
    const double length = n.length();
    return above && length > 0 ? std::min(nearest, std::abs((p - c[0]).dot(n)) / length) : nearest;
}

double from_surface(const Sphere& s, const V3d& p) {
    return std::abs((p - V3d(s.center)).length() - double(s.radius));
}

/// Distance of a point from a disk; beyond the rim a lower bound, by the shorter of the two axes.
double from_surface(const Disk& d, const V3d& p) {
    const V3d u(d.half_u), v(d.half_v), q = p - V3d(d.center), n = u.cross(v);
    const double nn = n.dot(n), uu = u.dot(u), vv = v.dot(v), uv = u.dot(v);
    if (!(nn > 0)) return std::numeric_limits<double>::infinity();
    const double a = q.dot(v.cross(n)) / nn, b = q.dot(n.cross(u)) / nn;
    const double shorter = std::sqrt(std::max(0.0, 0.5 * (uu + vv - std::hypot(uu - vv, 2 * uv))));
    const double beyond = std::max(0.0, std::hypot(a, b) - 1.0) * shorter;
    return std::hypot(q.dot(n) / std::sqrt(nn), beyond);
}

double from_surface(const Cylinder& c, const V3d& p) {
    const V3d axis = V3d(c.p1) - V3d(c.p0), q = p - V3d(c.p0);
    const double length = axis.length();
    if (!(length > 0)) return std::numeric_limits<double>::infinity();
    const double along = q.dot(axis) / length;
    const double across = (q - axis * (along / length)).length() - double(c.radius);
    return std::hypot(across, std::max({0.0, -along, along - length}));
}

double highest(const Sphere& s, const V3d& n) {
    return V3d(s.center).dot(n) + double(s.radius) * n.length();
}

double highest(const Disk& d, const V3d& n) {
    return V3d(d.center).dot(n) + std::hypot(V3d(d.half_u).dot(n), V3d(d.half_v).dot(n));
}

double highest(const Cylinder& c, const V3d& n) {
    const V3d axis = V3d(c.p1) - V3d(c.p0);
    const double along2 = axis.dot(axis) > 0 ? axis.dot(n) * axis.dot(n) / axis.dot(axis) : 0.0;
    return std::max(V3d(c.p0).dot(n), V3d(c.p1).dot(n)) +
           double(c.radius) * std::sqrt(std::max(0.0, n.dot(n) - along2));
}

}  // namespace

double distance_from(const Shape& shape, std::uint32_t primitive, const Placement* placement, const V3d& p,
                     double within) {
    return std::visit(
        [&](const auto& kind) {
            using Kind = std::decay_t<decltype(kind)>;
            if constexpr (std::is_same_v<Kind, Mesh>)
                return from_triangle(p, corners_of(kind, primitive, placement), within);
            else if constexpr (std::is_same_v<Kind, Instance>)
                return std::numeric_limits<double>::infinity();  // its members are hit, never the instance itself
            else
                return placement ? from_surface(kind, placement->point_to_local(p)) * placement->least_stretch()
                                 : from_surface(kind, p);
        },
        shape.geometry);
}

double highest_along(const Shape& shape, std::uint32_t primitive, const Placement* placement, const V3d& normal) {
    return std::visit(
        [&](const auto& kind) {
            using Kind = std::decay_t<decltype(kind)>;
            if constexpr (std::is_same_v<Kind, Mesh>) {
                const Corners c = corners_of(kind, primitive, placement);
                return std::max({c[0].dot(normal), c[1].dot(normal), c[2].dot(normal)});
            } else if constexpr (std::is_same_v<Kind, Instance>) {
                return -std::numeric_limits<double>::infinity();
            } else {
                return placement ? highest(kind, placement->covector_to_local(normal)) +
                                       placement->point_to_world(V3d(0.0)).dot(normal)
                                 : highest(kind, normal);
            }
        },
        shape.geometry);
}

}  // namespace treefarm
