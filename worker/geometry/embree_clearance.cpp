// SPDX-License-Identifier: Apache-2.0
// Distance that rays keep from walls, so that rounding moves no ray through them.
#include <algorithm>
#include <cmath>

#include "common/base/float_traps.h"
#include "worker/geometry/embree_api.h"
#include "worker/geometry/embree_scene.h"
#include "worker/geometry/primitive_reach.h"

namespace treefarm {

using Imath::V3d;

/// A neighbourhood query and its answer, for Embree's callback.
struct EmbreeScene::Surroundings {
    /// Query about a point's neighbourhood: whether a primitive reaches into the ball.
    struct Ball {
        V3d centre;
        double radius;
        const Hit* own = nullptr;  ///< primitive to ignore, with all that stay below its plane
        V3d normal{0.0};           ///< normal of that plane, on the upper side
        double lowest = 0;         ///< least dot(x, normal) of points that are above the plane beyond rounding error
    };

    const EmbreeScene& scene;
    const Ball& ball;
    bool crowded = false;

    static bool visit(RTCPointQueryFunctionArguments* args) {
        const TrapFloats ours;
        auto& self = *static_cast<Surroundings*>(args->userPtr);
        const bool placed = args->context->instStackSize != 0;
        if (!self.reaches_in(placed ? args->context->instID[0] : kNoInstance, args->geomID, args->primID)) return false;
        self.crowded = true;
        args->query->radius = 0.0f;  // found: the query may end
        return true;
    }

    bool reaches_in(std::uint32_t instance, std::uint32_t id, std::uint32_t primitive) const {
        const Placement* placement =
            instance == kNoInstance ? nullptr : &scene.placements_[scene.surfaces_[instance].placement];
        const std::uint32_t index = placement ? scene.groups_[placement->group()].members[id] : id;
        const Hit* own = ball.own;
        if (own && own->shape == index && own->primitive == primitive &&
            own->instance == (placement ? instance + 1 : 0u))
            return false;
        const Shape& shape = scene.shapes_[index];
        if (own && !(highest_along(shape, primitive, placement, ball.normal) > ball.lowest)) return false;
        return distance_from(shape, primitive, placement, ball.centre, ball.radius) < ball.radius;
    }

    static bool crowd(const EmbreeScene& scene, const Ball& ball) {
        Surroundings surroundings{scene, ball};
        RTCPointQueryContext context;
        rtcInitPointQueryContext(&context);
        RTCPointQuery query;
        query.x = static_cast<float>(ball.centre.x);
        query.y = static_cast<float>(ball.centre.y);
        query.z = static_cast<float>(ball.centre.z);
        query.time = 0.0f;
        query.radius = static_cast<float>(1.25 * ball.radius);  // rounding error here and under instances is far less
        const LetFloatsBe embree;
        rtcPointQuery(scene.scene_.get(), &query, &context, visit, &surroundings);
        return surroundings.crowded;
    }
};

void EmbreeScene::find_extents() {
    extents_.reserve(shapes_.size());
    for (const Shape& shape : shapes_) {
        const Box3 box = own_box(shape);
        const double extent = box.isEmpty() ? 0.0 : (V3d(box.max) - V3d(box.min)).length();
        extents_.push_back(std::isfinite(extent) ? extent : 0.0);
        largest_extent_ = std::max(largest_extent_, extents_.back());
    }
}

/// Least distance from a surface at which a ray origin is reliably on the computed side. A quarter of the offset bounds
/// the rounding of positions (8 half-ulps of their coordinates). Embree's dot products decide the side of a triangle up
/// to rounding of the triangle's extent, for which 16 half-ulps are added. A small shape may be close to a large one,
/// whose extent counts as at most 64 times the small one's.
double EmbreeScene::clearance(const Hit& hit) const {
    double extent = extents_[hit.shape];
    if (hit.instance) extent *= placements_[surfaces_[hit.instance - 1].placement].most_stretch();
    extent = std::max(extent, std::min(largest_extent_, 64.0 * extent));
    return 0.25 * double(hit.error) + 0x1p-20 * extent;
}

void EmbreeScene::step_back(Hit& hit, const Ray& ray) const {
    const V3d origin(ray.origin), direction(ray.direction), p(hit.p);
    const V3d normal = dot(hit.ng, ray.direction) > 0.0f ? -V3d(hit.ng) : V3d(hit.ng);
    const double offset = double(hit.error), clear = clearance(hit);
    // Between the surface and the end of the offset.
    if (!Surroundings::crowd(
            *this, {p + normal * (0.5 * offset), 0.5 * offset + clear, &hit, normal, p.dot(normal) + 0.25 * clear}))
        return;
    // The ray was unoccluded up to here: without close geometry its rounded points are on its side of everything.
    const double length2 = direction.dot(direction), length = (p - origin).dot(direction) / length2;
    const double least = 2.0 * clear / std::sqrt(length2);
    if (!(least > 0.0) || !std::isfinite(length)) return;
    V3d start = origin;
    for (double back = least; back < length; back *= 2.0) {
        const V3d candidate = origin + direction * (length - back);
        if (Surroundings::crowd(*this, {candidate, clear})) continue;
        start = candidate;
        break;
    }
    // offset_origin() must lead to this point.
    hit.error = static_cast<float>(std::max(offset, (start - p).dot(normal)));
    hit.p = Vec3(start - normal * double(hit.error));
}

}  // namespace treefarm
