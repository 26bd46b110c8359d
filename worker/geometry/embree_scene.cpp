// SPDX-License-Identifier: Apache-2.0
#include "worker/geometry/embree_scene.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "common/base/float_traps.h"
#include "worker/geometry/embree_api.h"
#include "worker/geometry/embree_ray.h"
#include "worker/geometry/primitive_points.h"
#include "worker/geometry/user_geometry.h"

namespace treefarm {

void EmbreeScene::intersect(std::span<const Query> queries) const {
    for (; queries.size() > kPacket; queries = queries.subspan(kPacket))
        intersect_packet(queries.first(kPacket));
    if (!queries.empty()) intersect_packet(queries);
}

void EmbreeScene::intersect_packet(std::span<const Query> queries) const {
    EmbreeRays rays;
    alignas(32) std::array<int, kPacket> valid{};
    RTCRayHit8 packet;
    std::fill_n(packet.ray.tnear, kPacket, 0.0f);
    std::fill_n(packet.ray.time, kPacket, 0.0f);
    std::fill_n(packet.ray.mask, kPacket, ~0u);
    std::fill_n(packet.ray.flags, kPacket, 0u);
    if (hides_) [[unlikely]]
        for (std::size_t i = 0; i < queries.size(); ++i)
            packet.ray.id[i] = queries[i].ray->of_camera ? kCameraRay : 0;
    std::fill_n(packet.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
    if (queries.size() < kPacket) {
        // Embree may look at lanes without a ray, whatever `valid` says: they are numbers, and end before they begin.
        for (float* const lanes : {packet.ray.org_x, packet.ray.org_y, packet.ray.org_z, packet.ray.dir_x,
                                   packet.ray.dir_y, packet.ray.dir_z})
            std::fill_n(lanes, kPacket, 0.0f);
        std::fill_n(packet.ray.tfar, kPacket, -1.0f);
    }
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const Ray& ray = *queries[i].ray;
        valid[i] = -1;
        packet.ray.org_x[i] = ray.origin.x;
        packet.ray.org_y[i] = ray.origin.y;
        packet.ray.org_z[i] = ray.origin.z;
        packet.ray.dir_x[i] = ray.direction.x;
        packet.ray.dir_y[i] = ray.direction.y;
        packet.ray.dir_z[i] = ray.direction.z;
        packet.ray.tfar[i] = ray.length;
    }
    {
        const LetFloatsBe embree;
        rays.intersect(scene_.get(), valid.data(), packet);
    }
    const RTCHit8& hit = packet.hit;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        *queries[i].found = hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        if (hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        *queries[i].embree_hit = {hit.instID[0][i], hit.geomID[i], hit.primID[i],
                                  hit.u[i],         hit.v[i],      {hit.Ng_x[i], hit.Ng_y[i], hit.Ng_z[i]}};
        if (hit.instID[0][i] == RTC_INVALID_GEOMETRY_ID)
            prefetch_line(surfaces_[hit.geomID[i]].indices + 3 * std::size_t(hit.primID[i]));
    }
}

void EmbreeScene::set_point(Hit& hit, const EmbreeHit& m) const {
    static_assert(kNoInstance == RTC_INVALID_GEOMETRY_ID);
    if (m.instance == kNoInstance)
        set_triangle_point(hit, m.id, m.primitive, m.u, m.v);
    else
        hit = other_point(m.instance, m.id, m.primitive, m.u, m.v, m.outward);
}

bool EmbreeScene::intersect(const Ray& ray, Hit& hit) const {
    EmbreeHit embree_hit;
    bool found;
    const Query query{&ray, &embree_hit, &found};
    intersect({&query, 1});
    if (found) set_point(hit, embree_hit);
    return found;
}

bool EmbreeScene::occluded(const Ray& ray) const {
    RTCRay query = to_embree(ray);
    const LetFloatsBe embree;
    EmbreeRays().occluded(scene_.get(), query);
    return query.tfar < 0.0f;
}

void EmbreeScene::occluded(std::span<const Ray> rays, bool* hidden) const {
    assert(rays.size() <= kMostTogether);
    std::array<RTCRay, kMostTogether> queries;
    for (std::size_t i = 0; i < rays.size(); ++i)
        queries[i] = to_embree(rays[i]);
    const LetFloatsBe embree;
    EmbreeRays().occluded(scene_.get(), {queries.data(), rays.size()});
    for (std::size_t i = 0; i < rays.size(); ++i)
        hidden[i] = queries[i].tfar == -std::numeric_limits<float>::infinity();
}

void EmbreeScene::set_triangle_point(Hit& hit, std::uint32_t shape, std::uint32_t primitive, float b1, float b2) const {
    const Surface& surface = surfaces_[shape];
    const std::uint32_t* corner = surface.indices + 3 * std::size_t(primitive);
    const Vec3 &v0 = surface.positions[corner[0]], &v1 = surface.positions[corner[1]],
               &v2 = surface.positions[corner[2]];
    hit.shape = shape;
    hit.primitive = primitive;
    hit.instance = 0;
    FlatTriangle(v0, v1, v2).set_point(hit, b1, b2);
    if (surface.normals) {
        const Vec3 n = surface.normals[corner[0]] * (1.0f - b1 - b2) + surface.normals[corner[1]] * b1 +
                       surface.normals[corner[2]] * b2;
        const float length2 = dot(n, n);
        if (length2 > 1e-12f && length2 < 1e12f) {  // neither zero nor NaN
            hit.ns = n * (1.0f / std::sqrt(length2));
            if (dot(hit.ng, hit.ns) < 0.0f) hit.ng = -hit.ng;
        }
    }
}

std::vector<FlatTriangle> EmbreeScene::flat_triangles(std::uint32_t shape) const {
    const Surface& surface = surfaces_[shape];
    std::vector<FlatTriangle> triangles;
    if (surface.normals) return triangles;
    for (std::size_t i = 0; i < 3 * std::size_t(surface.triangle_count); i += 3)
        triangles.emplace_back(surface.positions[surface.indices[i]], surface.positions[surface.indices[i + 1]],
                               surface.positions[surface.indices[i + 2]]);
    return triangles;
}

Hit EmbreeScene::triangle_point(std::uint32_t shape, std::uint32_t primitive, float b1, float b2) const {
    Hit hit;
    set_triangle_point(hit, shape, primitive, b1, b2);
    return hit;
}

/// Surface point of a hit under an instance, or on a shape that is no mesh.
Hit EmbreeScene::other_point(std::uint32_t instance, std::uint32_t id, std::uint32_t primitive, float u, float v,
                             const Vec3& outward) const {
    const Placement* placement = instance == kWorldUserShape ? nullptr : &placements_[surfaces_[instance].placement];
    const std::uint32_t shape = placement ? groups_[placement->group()].members[id] : id;
    Hit hit;
    switch (shapes_[shape].geometry.index()) {
        case 0:
            hit = triangle_point(shape, primitive, u, v);
            break;
        case 1:
            hit = sphere_point(shape, outward);
            break;
        case 2:
            hit = disk_point(shape, u, v);
            break;
        default:
            hit = cylinder_point(shape, u, outward);
    }
    return placement ? placement->to_world(hit) : hit;
}

Hit EmbreeScene::sphere_point(std::uint32_t shape, const Vec3& outward) const {
    Hit hit = treefarm::sphere_point(std::get<Sphere>(shapes_[shape].geometry), outward);
    hit.shape = shape;
    return hit;
}

Hit EmbreeScene::disk_point(std::uint32_t shape, float a, float b) const {
    Hit hit = treefarm::disk_point(std::get<Disk>(shapes_[shape].geometry), a, b);
    hit.shape = shape;
    return hit;
}

Hit EmbreeScene::cylinder_point(std::uint32_t shape, float along, const Vec3& outward) const {
    Hit hit = treefarm::cylinder_point(std::get<Cylinder>(shapes_[shape].geometry), along, outward);
    hit.shape = shape;
    return hit;
}

/// Direction away from the centre of a sphere or the axis of a cylinder, in the shape's own space; the normal at the
/// hit is derived from it. Unused by other shapes.
Vec3 EmbreeScene::outward(const Hit& hit) const {
    const auto* sphere = std::get_if<Sphere>(&shapes_[hit.shape].geometry);
    const auto* cylinder = std::get_if<Cylinder>(&shapes_[hit.shape].geometry);
    if (!sphere && !cylinder) return Vec3(0.0f);
    const Vec3 n = hit.instance ? placements_[surfaces_[hit.instance - 1].placement].normal_to_local(hit.ng) : hit.ng;
    return (sphere ? sphere->flip_normals : cylinder->flip_normals) ? -n : n;
}

Vec2 EmbreeScene::uv(const Hit& hit) const {
    return shape_uv(shapes_[hit.shape], hit.primitive, hit.b1, hit.b2, outward(hit));
}

SurfaceDetail EmbreeScene::detail(const Hit& hit) const {
    SurfaceDetail detail = shape_detail(shapes_[hit.shape], hit.primitive, hit.b1, hit.b2, outward(hit));
    if (hit.instance) {
        const Placement& placement = placements_[surfaces_[hit.instance - 1].placement];
        detail.dp_du = placement.vector_to_world(detail.dp_du);
        detail.dp_dv = placement.vector_to_world(detail.dp_dv);
    }
    return detail;
}

float EmbreeScene::opacity(const Hit& hit) const {
    const Mask* m = mask(hit.shape);
    return m ? m->opacity_at(hit.primitive, hit.b1, hit.b2, outward(hit)) : 1.0f;
}

double EmbreeScene::triangle_area(std::uint32_t shape, std::uint32_t primitive) const {
    const Surface& surface = surfaces_[shape];
    const std::uint32_t* corner = surface.indices + 3 * std::size_t(primitive);
    const Imath::V3d v0(surface.positions[corner[0]]), v1(surface.positions[corner[1]]),
        v2(surface.positions[corner[2]]);
    const Imath::V3d n = (v1 - v0).cross(v2 - v0);
    return 0.5 * std::sqrt(n.dot(n));
}

}  // namespace treefarm
