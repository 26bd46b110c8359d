// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm::test {

/// Scenes made in code: tests of light need no reader and no files.

inline std::int32_t add_diffuse(Scene& scene, const Rgb& reflectance, bool twosided = false) {
    Material material;
    material.bsdf = DiffuseMaterial{reflectance};
    material.twosided = twosided;
    scene.materials.push_back(material);
    return static_cast<std::int32_t>(scene.materials.size()) - 1;
}

/// Adds a shape and returns its index; a `radiance` that is not black makes it an area emitter.
inline std::int32_t add_shape(Scene& scene, decltype(Shape::geometry) geometry, std::int32_t material,
                              const Rgb& radiance = Rgb(0.0f), const std::string& name = "shape") {
    Shape shape;
    shape.geometry = std::move(geometry);
    shape.material = material;
    shape.name = name;
    const auto index = static_cast<std::int32_t>(scene.shapes.size());
    if (!is_black(radiance)) {
        shape.emitter = static_cast<std::int32_t>(scene.emitters.size());
        scene.emitters.push_back({AreaEmitter{radiance, index}, {}});
    }
    scene.shapes.push_back(std::move(shape));
    return index;
}

/// Appends a parallelogram: corner, corner + a, corner + a + b, corner + b. Its front is in the direction of a x b.
inline void append_quad(Mesh& mesh, const Vec3& corner, const Vec3& a, const Vec3& b) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : {corner, corner + a, corner + a + b, corner + b})
        mesh.positions.push_back(p);
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u})
        mesh.indices.push_back(first + i);
}

inline Mesh quad(const Vec3& corner, const Vec3& a, const Vec3& b) {
    Mesh mesh;
    append_quad(mesh, corner, a, b);
    return mesh;
}

/// Box [lower, upper] with fronts outside, or inside for a room.
inline Mesh box(const Vec3& lower, const Vec3& upper, bool inwards) {
    const Vec3 e = upper - lower;
    const Vec3 x(e.x, 0.0f, 0.0f), y(0.0f, e.y, 0.0f), z(0.0f, 0.0f, e.z);
    Mesh mesh;
    const std::array<std::array<Vec3, 3>, 6> faces = {
        {{lower, y, x}, {lower, x, z}, {lower, z, y}, {upper, -x, -y}, {upper, -z, -x}, {upper, -y, -z}}};
    for (const auto& [corner, a, b] : faces)
        append_quad(mesh, corner, inwards ? b : a, inwards ? a : b);
    return mesh;
}

/// Sphere of triangles, fronts outside: 4^subdivisions times an octahedron.
inline Mesh sphere_mesh(const Vec3& center, float radius, int subdivisions, bool smooth) {
    std::vector<std::array<Vec3, 3>> triangles;
    for (int octant = 0; octant < 8; ++octant) {
        const float sx = octant & 1 ? -1.0f : 1.0f, sy = octant & 2 ? -1.0f : 1.0f, sz = octant & 4 ? -1.0f : 1.0f;
        std::array<Vec3, 3> t = {Vec3(sx, 0, 0), Vec3(0, sy, 0), Vec3(0, 0, sz)};
        if (sx * sy * sz < 0.0f) std::swap(t[1], t[2]);
        triangles.push_back(t);
    }
    for (int level = 0; level < subdivisions; ++level) {
        std::vector<std::array<Vec3, 3>> finer;
        for (const auto& [a, b, c] : triangles) {
            const Vec3 ab = normalize(a + b), bc = normalize(b + c), ca = normalize(c + a);
            for (const std::array<Vec3, 3>& t :
                 {std::array<Vec3, 3>{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
                finer.push_back(t);
        }
        triangles = std::move(finer);
    }
    Mesh mesh;
    for (const auto& t : triangles)
        for (const Vec3& n : t) {
            mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(center + n * radius);
            if (smooth) mesh.normals.push_back(n);
        }
    return mesh;
}

/// Camera at `origin` looking at `target`, square film whose half width is tan_half at unit distance.
inline Camera look_at(const Vec3& origin, const Vec3& target, const Vec3& up, float tan_half) {
    const Vec3 forward = normalize(target - origin);
    const Vec3 right = normalize(cross(forward, up));
    const Vec3 above = cross(right, forward);
    Camera camera;
    camera.origin = origin;
    camera.across = right * (2.0f * tan_half);
    camera.down = above * (-2.0f * tan_half);
    camera.corner = forward - right * tan_half + above * tan_half;
    return camera;
}

inline void set_film(Scene& scene, int width, int height) {
    scene.film.width = width;
    scene.film.height = height;
}

/// Closed cube that emits `radiance` and reflects `albedo` everywhere, seen from inside: every ray carries radiance /
/// (1 - albedo).
inline Scene furnace(float albedo, float radiance, float size, const Vec3& center) {
    Scene scene;
    const std::int32_t material = add_diffuse(scene, Rgb(albedo));
    const Vec3 half(0.5f * size);
    add_shape(scene, box(center - half, center + half, true), material, Rgb(radiance), "furnace");
    scene.camera = look_at(center, center + Vec3(0.3f, 0.5f, 1.0f) * size, Vec3(0, 1, 0), 1.0f);
    set_film(scene, 8, 8);
    return scene;
}

/// A room of unit size (scaled and moved) with coloured walls, two boxes and a lamp below the ceiling, open towards the
/// camera, similar to the Cornell box.
inline Scene cornell_box(float scale, const Vec3& offset) {
    Scene scene;
    const std::int32_t white = add_diffuse(scene, {0.73f, 0.72f, 0.68f}),
                       red = add_diffuse(scene, {0.6f, 0.06f, 0.05f}), green = add_diffuse(scene, {0.12f, 0.45f, 0.1f});
    const auto at = [&](float x, float y, float z) { return offset + Vec3(x, y, z) * scale; };
    const Vec3 x(scale, 0, 0), y(0, scale, 0), z(0, 0, scale);
    add_shape(scene, quad(at(0, 0, 0), z, x), white, Rgb(0.0f), "floor");
    add_shape(scene, quad(at(0, 1, 0), x, z), white, Rgb(0.0f), "ceiling");
    add_shape(scene, quad(at(0, 0, 1), y, x), white, Rgb(0.0f), "back");
    add_shape(scene, quad(at(1, 0, 0), z, y), red, Rgb(0.0f), "left");
    add_shape(scene, quad(at(0, 0, 0), y, z), green, Rgb(0.0f), "right");
    add_shape(scene, box(at(0.15f, 0.0f, 0.5f), at(0.45f, 0.6f, 0.8f), false), white, Rgb(0.0f), "tall");
    add_shape(scene, box(at(0.55f, 0.0f, 0.2f), at(0.85f, 0.3f, 0.5f), false), white, Rgb(0.0f), "short");
    add_shape(scene, quad(at(0.38f, 0.99f, 0.4f), x * 0.24f, z * 0.2f), white, Rgb(18.0f, 14.0f, 8.0f), "lamp");
    scene.camera = look_at(at(0.5f, 0.5f, -1.4f), at(0.5f, 0.5f, 0.0f), Vec3(0, 1, 0), 0.357f);
    set_film(scene, 64, 64);
    return scene;
}

}  // namespace treefarm::test
