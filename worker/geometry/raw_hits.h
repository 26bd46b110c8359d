// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/model/shape.h"
#include "worker/geometry/embree_api.h"

namespace treefarm {

/// Ray intersection with analytic shapes, solved in double: a float quadratic loses a small sphere far away, and one
/// whose surface the ray starts on. Each intersect() offers the hits in (tnear, tfar], nearest first, to `accept(hit)`
/// until it returns true; false if it never does.

/// Intersection of a ray with an analytic shape.
struct RawHit {
    double t = 0;         ///< in units of the ray's direction
    Imath::V3d ng;        ///< outwards; unit for spheres and cylinders
    double u = 0, v = 0;  ///< disk: coordinates along its half axes; cylinder: u along its axis, 0 to 1
};

namespace detail {

inline Imath::V3d origin(const RTCRay& ray) {
    return {double(ray.org_x), double(ray.org_y), double(ray.org_z)};
}

inline Imath::V3d direction(const RTCRay& ray) {
    return {double(ray.dir_x), double(ray.dir_y), double(ray.dir_z)};
}

inline bool in_range(double t, const RTCRay& ray) {
    return t > double(ray.tnear) && t <= double(ray.tfar);
}

}  // namespace detail

template <class Accept>
bool intersect(const Sphere& sphere, const RTCRay& ray, const Accept& accept) {
    const Imath::V3d o = detail::origin(ray) - Imath::V3d(sphere.center), d = detail::direction(ray);
    const double radius = double(sphere.radius), dd = d.dot(d);
    if (!(dd > 0)) return false;
    const double middle = -o.dot(d) / dd;
    // Discriminant from the ray's closest point to the centre: no difference of large squares.
    const Imath::V3d closest = o + d * middle;
    const double discriminant = radius * radius - closest.dot(closest);
    if (!(discriminant >= 0)) return false;
    const double half_chord = std::sqrt(discriminant / dd);
    for (const double t : {middle - half_chord, middle + half_chord})
        if (detail::in_range(t, ray) && accept(RawHit{t, (o + d * t) / radius})) return true;
    return false;
}

template <class Accept>
bool intersect(const Disk& disk, const RTCRay& ray, const Accept& accept) {
    const Imath::V3d o = Imath::V3d(disk.center) - detail::origin(ray), d = detail::direction(ray);
    const Imath::V3d half_u(disk.half_u), half_v(disk.half_v);
    const Imath::V3d n = half_u.cross(half_v);
    const double nn = n.dot(n), approach = d.dot(n);
    if (!(nn > 0) || approach == 0) return false;
    const double t = o.dot(n) / approach;
    if (!detail::in_range(t, ray)) return false;
    const Imath::V3d q = d * t - o;
    const double a = q.dot(half_v.cross(n)) / nn, b = q.dot(n.cross(half_u)) / nn;
    if (!(a * a + b * b <= 1)) return false;
    return accept(RawHit{t, n, a, b});
}

template <class Accept>
bool intersect(const Cylinder& cylinder, const RTCRay& ray, const Accept& accept) {
    const Imath::V3d o = detail::origin(ray) - Imath::V3d(cylinder.p0), d = detail::direction(ray);
    const Imath::V3d axis = Imath::V3d(cylinder.p1) - Imath::V3d(cylinder.p0);
    const double radius = double(cylinder.radius), length2 = axis.dot(axis);
    if (!(length2 > 0)) return false;
    // Projected along the axis it is a circle.
    const Imath::V3d o2 = o - axis * (o.dot(axis) / length2), d2 = d - axis * (d.dot(axis) / length2);
    const double dd = d2.dot(d2);
    if (!(dd > 0)) return false;
    const double middle = -o2.dot(d2) / dd;
    const Imath::V3d closest = o2 + d2 * middle;
    const double discriminant = radius * radius - closest.dot(closest);
    if (!(discriminant >= 0)) return false;
    const double half_chord = std::sqrt(discriminant / dd);
    for (const double t : {middle - half_chord, middle + half_chord}) {
        if (!detail::in_range(t, ray)) continue;
        const double along = (o + d * t).dot(axis) / length2;
        if (along >= 0 && along <= 1 && accept(RawHit{t, (o2 + d2 * t) / radius, along})) return true;
    }
    return false;
}

}  // namespace treefarm
