// SPDX-License-Identifier: Apache-2.0
#include "worker/geometry/user_geometry.h"

#include <cmath>
#include <limits>

#include "common/base/float_traps.h"
#include "worker/geometry/embree_api.h"
#include "worker/geometry/mask.h"
#include "worker/geometry/raw_hits.h"

namespace treefarm {
namespace {

/// Sets a box about `center` that is slightly too large.
void set_bounds(RTCBounds& bounds, const Imath::V3d& lower, const Imath::V3d& upper) {
    constexpr double kMargin = 0x1p-21;
    const auto below = [](double x) { return static_cast<float>(x - kMargin * std::abs(x)); };
    const auto above = [](double x) { return static_cast<float>(x + kMargin * std::abs(x)); };
    bounds.lower_x = below(lower.x);
    bounds.lower_y = below(lower.y);
    bounds.lower_z = below(lower.z);
    bounds.upper_x = above(upper.x);
    bounds.upper_y = above(upper.y);
    bounds.upper_z = above(upper.z);
}

void find_bounds(const Sphere& s, RTCBounds& bounds) {
    const Imath::V3d center(s.center), extent{double(s.radius)};
    set_bounds(bounds, center - extent, center + extent);
}

void find_bounds(const Disk& d, RTCBounds& bounds) {
    const Imath::V3d center(d.center), u(d.half_u), v(d.half_v);
    const Imath::V3d extent(std::sqrt(u.x * u.x + v.x * v.x), std::sqrt(u.y * u.y + v.y * v.y),
                            std::sqrt(u.z * u.z + v.z * v.z));
    set_bounds(bounds, center - extent, center + extent);
}

void find_bounds(const Cylinder& c, RTCBounds& bounds) {
    const Imath::V3d p0(c.p0), p1(c.p1);
    const Imath::V3d axis = p1 - p0;
    const double length2 = axis.dot(axis);
    Imath::V3d lower, upper;
    for (int i = 0; i < 3; ++i) {
        const double sine2 = length2 > 0 ? std::max(0.0, 1.0 - axis[i] * axis[i] / length2) : 1.0;
        const double extent = double(c.radius) * std::sqrt(sine2);
        lower[i] = std::min(p0[i], p1[i]) - extent;
        upper[i] = std::max(p0[i], p1[i]) + extent;
    }
    set_bounds(bounds, lower, upper);
}

/// Shape geometry behind Embree's user pointer, which points to it or to its mask.
template <class Geometry, bool kMasked>
const Geometry& geometry_of(const void* user) {
    if constexpr (kMasked)
        return std::get<Geometry>(static_cast<const Mask*>(user)->shape->geometry);
    else
        return *static_cast<const Geometry*>(user);
}

template <class Geometry, bool kMasked>
void bounds(const RTCBoundsFunctionArguments* args) {
    find_bounds(geometry_of<Geometry, kMasked>(args->geometryUserPtr), *args->bounds_o);
}

RTCHit to_hit(const RawHit& m, std::uint32_t shape, std::uint32_t primitive, std::uint32_t instance) {
    RTCHit hit;
    hit.Ng_x = static_cast<float>(m.ng.x);
    hit.Ng_y = static_cast<float>(m.ng.y);
    hit.Ng_z = static_cast<float>(m.ng.z);
    hit.u = static_cast<float>(m.u);
    hit.v = static_cast<float>(m.v);
    hit.primID = primitive;
    hit.geomID = shape;
    set_instance(hit, instance == RTC_INVALID_GEOMETRY_ID ? kWorldUserShape : instance);
    return hit;
}

template <class Geometry, bool kMasked, class Args>
bool find(const Args& args, const RTCRay& ray, RTCHit& hit, double& t) {
    const TrapFloats ours;
    return intersect(geometry_of<Geometry, kMasked>(args.geometryUserPtr), ray, [&](const RawHit& m) {
        hit = to_hit(m, args.geomID, args.primID, args.context->instID[0]);
        t = m.t;
        if constexpr (kMasked) return static_cast<const Mask*>(args.geometryUserPtr)->accepts(&ray, &hit);
        return true;
    });
}

// Callbacks take any number of rays.

template <class Geometry, bool kMasked>
void intersect(const RTCIntersectFunctionNArguments* args) {
    RTCRayN* const rays = RTCRayHitN_RayN(args->rayhit, args->N);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        RTCHit hit;
        double t = 0;
        if (!find<Geometry, kMasked>(*args, rtcGetRayFromRayN(rays, args->N, i), hit, t)) continue;
        RTCRayN_tfar(rays, args->N, i) = static_cast<float>(t);
        rtcCopyHitToHitN(RTCRayHitN_HitN(args->rayhit, args->N), &hit, args->N, i);
    }
}

template <class Geometry, bool kMasked>
void occluded(const RTCOccludedFunctionNArguments* args) {
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        RTCHit hit;
        double t = 0;
        if (find<Geometry, kMasked>(*args, rtcGetRayFromRayN(args->ray, args->N, i), hit, t))
            RTCRayN_tfar(args->ray, args->N, i) = -std::numeric_limits<float>::infinity();
    }
}

template <class Geometry, bool kMasked>
void set_callbacks(RTCGeometry geometry, const void* user) {
    rtcSetGeometryUserPrimitiveCount(geometry, 1);
    rtcSetGeometryUserData(geometry, const_cast<void*>(user));
    rtcSetGeometryBoundsFunction(geometry, bounds<Geometry, kMasked>, nullptr);
    rtcSetGeometryIntersectFunction(geometry, intersect<Geometry, kMasked>);
    rtcSetGeometryOccludedFunction(geometry, occluded<Geometry, kMasked>);
}

}  // namespace

void set_user_callbacks(RTCGeometry geometry, const Shape& shape, const Mask* mask) {
    std::visit(
        [&](const auto& kind) {
            using Geometry = std::decay_t<decltype(kind)>;
            if constexpr (!std::is_same_v<Geometry, Mesh> && !std::is_same_v<Geometry, Instance>) {
                if (mask)
                    set_callbacks<Geometry, true>(geometry, mask);
                else
                    set_callbacks<Geometry, false>(geometry, &kind);
            }
        },
        shape.geometry);
}

}  // namespace treefarm
