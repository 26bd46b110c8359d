// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>
#include <vector>

#include "tests/support/test_scenes.h"
#include "worker/geometry/embree_scene.h"

namespace treefarm::test {

/// A watertight room, with the position of its middle.
struct ClosedRoom {
    std::string name;
    Imath::V3d at;
    std::vector<Shape> shapes;
};

/// A box of unit size, turned by these angles about z and then x, with faces of squares x squares x 2 triangles.
/// Corners shared by squares have equal bits: they are computed by the same operations.
inline Mesh turned_box(const Imath::V3d& at, double about_z, double about_x, int squares, bool inwards) {
    const auto placed = [&](Imath::V3d p) {
        p = {std::cos(about_z) * p.x - std::sin(about_z) * p.y, std::sin(about_z) * p.x + std::cos(about_z) * p.y, p.z};
        p = {p.x, std::cos(about_x) * p.y - std::sin(about_x) * p.z, std::sin(about_x) * p.y + std::cos(about_x) * p.z};
        return Vec3(p + at);
    };
    Mesh mesh;
    for (int face = 0; face < 6; ++face)
        for (int i = 0; i < squares; ++i)
            for (int j = 0; j < squares; ++j) {
                const auto first = static_cast<std::uint32_t>(mesh.positions.size());
                for (const auto& [u, v] : {std::pair(i, j), {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
                    Imath::V3d p;
                    p[face / 2] = face % 2 ? 0.5 : -0.5;
                    p[(face / 2 + 1) % 3] = double(u) / squares - 0.5;
                    p[(face / 2 + 2) % 3] = double(v) / squares - 0.5;
                    mesh.positions.push_back(placed(p));
                }
                const bool turn = (face % 2 == 1) == inwards;
                for (const std::uint32_t corner :
                     {0u, turn ? 2u : 1u, turn ? 1u : 2u, 0u, turn ? 3u : 2u, turn ? 2u : 3u})
                    mesh.indices.push_back(first + corner);
            }
    return mesh;
}

/// Closed rooms: boxes along the axes and turned, of few and of many triangles, one with a box that cuts into its
/// floor, a sphere, and an instanced box; `away`: distance from the origin in multiples of their sizes.
inline std::vector<ClosedRoom> closed_rooms(double away) {
    const Imath::V3d at = Imath::V3d(1.0, -0.7, 0.3).normalized() * away;
    std::vector<ClosedRoom> rooms;
    const auto add = [&](const std::string& name, const std::vector<decltype(Shape::geometry)>& parts) {
        Scene scene;
        for (const auto& part : parts)
            add_shape(scene, part, kNone);
        rooms.push_back({name, at, std::move(scene.shapes)});
    };
    add("box", {turned_box(at, 0, 0, 1, true)});
    add("turned box", {turned_box(at, 0.7, 0.4, 1, true)});
    add("turned box of many triangles", {turned_box(at, 0.7, 0.4, 8, true)});
    const Vec3 floor = Vec3(at) + Vec3(0.1f, -0.5f, 0.2f);
    add("box with furniture",
        {turned_box(at, 0, 0, 4, true), box(floor - Vec3(0.1f, 0.05f, 0.1f), floor + Vec3(0.2f), false)});
    add("ball", {Sphere{Vec3(at), 0.5f, true}});
    Instance instance;
    instance.group = 0;
    for (int i = 0; i < 3; ++i)
        instance.to_world[3][i] = static_cast<float>(at[i]);
    add("instance of a box", {turned_box(Imath::V3d(0.0), 0.7, 0.4, 2, true), instance});
    rooms.back().shapes[0].group = 0;
    return rooms;
}

/// Number of paths that leave the room, of `paths` diffuse ones with `edges` rays that start in its middle.
inline long escapes(const EmbreeScene& geometry, const Imath::V3d& middle, long paths, int edges, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    const auto direction = [&] { return normalize(Vec3(normal(random), normal(random), normal(random))); };
    long lost = 0;
    for (long i = 0; i < paths; ++i) {
        Ray ray{Vec3(middle + Imath::V3d(0.1, 0.05, -0.07)), direction()};
        for (int edge = 0; edge < edges; ++edge) {
            Hit hit;
            if (!geometry.intersect(ray, hit)) {
                ++lost;
                break;
            }
            geometry.keep_inside(hit, ray);
            const Vec3 next = direction();  // on the side that the ray came from
            ray = {Vec3(0.0f), dot(next, hit.ng) * dot(ray.direction, hit.ng) > 0.0f ? -next : next};
            ray.origin = offset_origin(hit, ray.direction);
        }
    }
    return lost;
}

}  // namespace treefarm::test
