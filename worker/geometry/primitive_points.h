// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/shape.h"
#include "worker/geometry/hit.h"

namespace treefarm {

/// Points of shapes from their parameters, with equal bits for points found by a ray and points chosen by a light
/// sampler. The caller sets `shape` and `primitive` of the hit.

inline float max_abs(const Vec3& v) {
    return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
}

/// Unit normal of a triangle with these edges; a product of edges that leaves the range of float is redone in double.
inline Vec3 unit_normal(const Vec3& e1, const Vec3& e2) {
    const Vec3 n = cross(e1, e2);
    const float length2 = dot(n, n);
    if (length2 > 1e-30f && length2 < 1e30f) return n * (1.0f / std::sqrt(length2));
    const Imath::V3d a(e1), b(e2);
    const Imath::V3d wide = a.cross(b);
    const double length = std::sqrt(wide.dot(wide));
    if (!(length > 0)) return {0.0f, 0.0f, 1.0f};  // no area: no ray finds it
    return Vec3(wide / length);
}

/// Per-triangle data that all of its points share.
struct FlatTriangle {
    Vec3 origin, e1, e2;
    Vec3 ng;
    float error;

    FlatTriangle(const Vec3& v0, const Vec3& v1, const Vec3& v2)
        : origin(v0),
          e1(v1 - v0),
          e2(v2 - v0),
          ng(unit_normal(e1, e2)),
          error(offset_bound(std::max(max_abs(v0), std::max(max_abs(v1), max_abs(v2))))) {}

    /// Surface point with these barycentrics, of a mesh without shading normals.
    void set_point(Hit& hit, float b1, float b2) const {
        hit.b1 = b1;
        hit.b2 = b2;
        hit.p = origin + (e1 * b1 + e2 * b2);
        hit.ng = ng;
        hit.ns = ng;
        hit.error = error;
    }
};

/// Surface point p of a sphere with its unit outward normal.
inline Hit sphere_hit(const Sphere& s, const Vec3& p, const Vec3& n) {
    Hit hit;
    hit.p = p;
    hit.error = offset_bound(max_abs(s.center) + s.radius);
    hit.ng = s.flip_normals ? -n : n;
    hit.ns = hit.ng;
    return hit;
}

/// Surface point of a sphere in the direction `outward` from its centre (need not be unit).
inline Hit sphere_point(const Sphere& s, const Vec3& outward) {
    const Vec3 n = normalize(outward);
    return sphere_hit(s, s.center + n * s.radius, n);
}

/// Surface point center + a * half_u + b * half_v.
inline Hit disk_point(const Disk& d, float a, float b) {
    Hit hit;
    hit.b1 = a;
    hit.b2 = b;
    hit.p = d.center + (d.half_u * a + d.half_v * b);
    hit.error = offset_bound(max_abs(d.center) + max_abs(d.half_u) + max_abs(d.half_v));
    hit.ng = unit_normal(d.half_u, d.half_v);
    hit.ns = hit.ng;
    return hit;
}

/// Surface point at `along` (0 to 1) of the axis, in the direction `outward` from it (perpendicular to the axis; need
/// not be unit).
inline Hit cylinder_point(const Cylinder& c, float along, const Vec3& outward) {
    Hit hit;
    const Vec3 n = normalize(outward);
    hit.b1 = along;
    hit.p = c.p0 + ((c.p1 - c.p0) * along + n * c.radius);
    hit.error = offset_bound(std::max(max_abs(c.p0), max_abs(c.p1)) + c.radius);
    hit.ng = c.flip_normals ? -n : n;
    hit.ns = hit.ng;
    return hit;
}

}  // namespace treefarm
