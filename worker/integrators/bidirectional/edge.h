// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/geometry/ray.h"
#include "worker/integrators/subpath/light_scatter.h"
#include "worker/integrators/subpath/technique_sums.h"

namespace treefarm {

inline double squared_distance(const Vec3& a, const Vec3& b) {
    const Imath::V3d d = Imath::V3d(a) - Imath::V3d(b);
    return d.dot(d);
}

/// Departure of a walk from a surface.
struct Departure {
    Vec3 p{0.0f};
    double cosine = 0;   ///< |out . ng|
    double pdf = 0;      ///< per steradian; of a delta lobe 1
    double reverse = 0;  ///< density of the other walk, coming back along this ray, towards the vertex before this one
    bool delta = false;
};

/// Edge from a departure to the surface that its ray hits; pdf 0 if the density is undefined.
inline DrawnEdge edge_to(const Departure& from, const Hit& hit, const Vec3& to_before) {
    const double distance2 = squared_distance(from.p, hit.p);
    if (!(distance2 > 0.0)) return {};
    return {from.pdf * double(geometric_cosine(hit, to_before)) / distance2, from.cosine / distance2, from.reverse,
            from.delta};
}

/// Edge from a departure out of the scene.
inline DrawnEdge edge_to_infinity(const Departure& from) {
    return {from.pdf, from.cosine, from.reverse, from.delta};
}

/// Density, without delta lobes, with which a walk that arrives from the side of `from` draws the direction `to`; both
/// are unit and point away from the surface. `scratch`: for this call alone.
template <class Surface>
double scatter_pdf(const TraceScene& scene, const Hit& hit, const Vec3& from, const Vec3& to,
                   typename Surface::Scratch& scratch) {
    const Surface surface(scene, hit, from, scratch);
    if (surface.black()) return 0.0;
    return double(surface.bsdf().value(surface.wo(), surface.frame().to_local(to)).pdf);
}

/// Segment between two surfaces, offset from both; `direction`: unit, from the first to the second.
inline Ray ray_between(const Hit& from, const Hit& to, const Vec3& direction) {
    Ray ray{offset_origin(from, direction), Vec3(0.0f), 1.0f};
    ray.direction = offset_origin(to, -direction) - ray.origin;
    // Closer than the offsets: no occluder fits between.
    if (!(dot(ray.direction, direction) > 0.0f)) ray.length = -1.0f;
    return ray;
}

}  // namespace treefarm
