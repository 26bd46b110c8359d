// SPDX-License-Identifier: Apache-2.0
// How far rays keep from walls, so that no rounding takes them through.
#include <algorithm>
#include <cmath>

#include "common/base/float_traps.h"
#include "worker/geometry/embree_api.h"
#include "worker/geometry/embree_scene.h"
#include "worker/geometry/primitive_reach.h"

namespace treefarm {
namespace {

using Imath::V3d;

/// A question about the surroundings of a point: whether a primitive reaches into the ball.
struct Ball {
    V3d centre;
    double radius;
    const Hit* own = nullptr;  ///< its primitive does not count, nor do those that stay below its plane
    V3d normal{0.0};           ///< of that plane, up
    double lowest = 0;         ///< dot(x, normal) of points that are above it beyond rounding
};

}  // namespace

/// One question about surroundings and its answer, for Embree's callback.
struct EmbreeScene::Surroundings {
    const EmbreeScene& scene;
    const Ball& ball;
    bool crowded = false;

    static bool visit(RTCPointQueryFunctionArguments* args) {
        const TrapFloats ours;
        auto& self = *static_cast<Surroundings*>(args->userPtr);
        const bool placed = args->context->instStackSize != 0;
        if (!self.reaches_in(placed ? args->context->instID[0] : kNoInstance, args->geomID, args->primID)) return false;
        self.crowded = true;
        args->query->radius = 0.0f;  // no need to look on
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
        query.radius = static_cast<float>(1.25 * ball.radius);  // what rounds here and under instances is far less
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

/// How near to a surface a ray may start and still be on the side that arithmetic says it is on. A quarter of the error
/// bounds the rounding of positions (8 half-steps of float of their coordinates); on which side of a triangle a point
/// is Embree's dot products tell up to rounding of its extent, from which 16 half-steps are kept. Near a small shape a
/// large one may stand, which counts as 64 times as large at most.
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
    // The ray has seen nothing up to here: where nothing is near it, its rounded points are on its side of everything.
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
    // offset_origin() has to lead there.
    hit.error = static_cast<float>(std::max(offset, (start - p).dot(normal)));
    hit.p = Vec3(start - normal * double(hit.error));
}

}  // namespace treefarm
