// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/meshes/triangulate.h"

#include <cmath>

namespace treefarm {
namespace {

constexpr std::size_t kMaxConcaveCorners = 256;

using Point = Imath::V2d;

/// Twice the signed area of a triangle: positive if it turns left.
double turn(const Point& a, const Point& b, const Point& c) {
    return (b - a).cross(c - a);
}

/// Normal of the polygon, with a length of twice its area (Newell's method).
Imath::V3d area_normal(std::span<const Vec3> polygon) {
    Imath::V3d normal(0.0);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Imath::V3d a(polygon[i]), b(polygon[(i + 1) % polygon.size()]);
        normal += Imath::V3d(a.y - b.y, a.z - b.z, a.x - b.x) * Imath::V3d(a.z + b.z, a.x + b.x, a.y + b.y);
    }
    return normal;
}

/// The polygon projected along its normal's largest component, so that it turns left.
std::vector<Point> project(std::span<const Vec3> polygon, const Imath::V3d& normal) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(normal[i]) > std::abs(normal[axis])) axis = i;
    const bool forward = normal[axis] > 0.0;
    const int u = (axis + (forward ? 1 : 2)) % 3, v = (axis + (forward ? 2 : 1)) % 3;
    std::vector<Point> points;
    for (const Vec3& p : polygon)
        points.emplace_back(p[u], p[v]);
    return points;
}

bool is_convex(const std::vector<Point>& points) {
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Point& a = points[i];
        const Point& b = points[(i + 1) % n];
        const Point& c = points[(i + 2) % n];
        // A corner that is straight within single precision does not make the polygon concave.
        if (turn(a, b, c) < -1e-6 * (b - a).length() * (c - b).length()) return false;
    }
    return true;
}

bool is_ear(const std::vector<Point>& points, const std::vector<std::size_t>& left, std::size_t at) {
    const std::size_t n = left.size();
    const std::size_t ia = left[(at + n - 1) % n], ib = left[at], ic = left[(at + 1) % n];
    const Point &a = points[ia], &b = points[ib], &c = points[ic];
    if (turn(a, b, c) <= 0.0) return false;
    for (const std::size_t i : left) {
        const Point& p = points[i];
        if (i == ia || i == ib || i == ic || p == a || p == b || p == c) continue;
        if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    }
    return true;
}

}  // namespace

bool triangulate(std::span<const Vec3> polygon, std::vector<std::array<std::size_t, 3>>& triangles) {
    const std::vector<Point> points = project(polygon, area_normal(polygon));
    std::vector<std::size_t> left(polygon.size());
    for (std::size_t i = 0; i < left.size(); ++i)
        left[i] = i;
    if (!is_convex(points)) {
        if (polygon.size() > kMaxConcaveCorners) return false;
        while (left.size() > 3) {
            std::size_t at = 0;
            while (at < left.size() && !is_ear(points, left, at))
                ++at;
            if (at == left.size()) break;  // the polygon intersects itself: a fan is as good as anything
            const std::size_t n = left.size();
            triangles.push_back({left[(at + n - 1) % n], left[at], left[(at + 1) % n]});
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
        }
    }
    for (std::size_t i = 1; i + 1 < left.size(); ++i)
        triangles.push_back({left[0], left[i], left[i + 1]});
    return true;
}

}  // namespace treefarm
