// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/area.h"

#include <numeric>
#include <optional>

#include "common/base/error.h"

namespace treefarm {
namespace {

/// Limit of the triangles that are stored flat: larger meshes would not stay in the cache.
constexpr std::size_t kMostFlat = 4096;

}  // namespace

AreaLight::AreaLight(const AreaEmitter& emitter, const LightScene& scene)
    : radiance(emitter.radiance.value),
      texture(emitter.radiance.texture),
      shape(static_cast<std::uint32_t>(emitter.shape)),
      sphere(scene.geometry->sphere(shape)),
      mask(scene.geometry->mask(shape)),
      by_cone(sphere && !(mask && sphere->flip_normals)) {
    if (texture != kNone && !scene.textures) throw RunError("an emitter has a texture, but there are no textures");
    const std::vector<double> areas = part_areas(*scene.geometry, shape);
    if (!sphere) {
        triangles = DiscreteTable(areas);
        area_density.resize(areas.size(), 0.0f);
        for (std::uint32_t i = 0; i < areas.size(); ++i)
            if (areas[i] > 0) area_density[i] = static_cast<float>(double(triangles.probability(i)) / areas[i]);
    }
    plain = scene.geometry->triangle_count(shape) > 0 && texture == kNone && !mask;
    if (plain && areas.size() <= kMostFlat) flat = scene.geometry->flat_triangles(shape);
}

Rgb AreaLight::mean_radiance(const LightScene& scene) const {
    return radiance *
           (texture != kNone ? mean_color(*scene.textures, texture, &scene.geometry->shape(shape)) : Rgb(1.0f));
}

double AreaLight::power(const LightScene& scene) const {
    const std::vector<double> areas = part_areas(*scene.geometry, shape);
    const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
    return area * double(kPi) * double(average(mean_radiance(scene)));
}

void AreaLight::cut(const LightScene& scene, float least_extent) {
    const EmbreeScene& geometry = *scene.geometry;
    if (geometry.triangle_count(shape) <= AreaPatches::kFewTriangles) return;
    const std::vector<double> areas = part_areas(geometry, shape);
    Box3 box;
    const auto center = [&](std::uint32_t triangle) {
        return geometry.triangle_point(shape, triangle, 1.0f / 3, 1.0f / 3).p;
    };
    for (std::uint32_t triangle = 0; triangle < areas.size(); ++triangle)
        if (areas[triangle] > 0) box.extendBy(center(triangle));
    const Vec3 size = box.isEmpty() ? Vec3(0.0f) : box.max - box.min;
    if (std::max(size.x, std::max(size.y, size.z)) < least_extent) return;
    patches = AreaPatches(areas, center);
}

LightBounds AreaLight::bounds(const LightScene& scene, std::uint32_t patch) const {
    const EmbreeScene& geometry = *scene.geometry;
    const auto mean = double(luminance(mean_radiance(scene)));
    if (geometry.triangle_count(shape) == 0) {
        LightBounds bounds = LightBounds::in_box(own_box(geometry.shape(shape)), mean * part_areas(geometry, shape)[0]);
        // Projected size: a convex shape's mean projected area is a quarter of its surface.
        if (sphere) bounds.radius = sphere->radius;
        if (std::holds_alternative<Disk>(geometry.shape(shape).geometry))
            bounds.cone = {geometry.disk_point(shape, 0.0f, 0.0f).ng, 0.0f};
        else
            bounds.amount *= 0.25;
        return bounds;
    }
    Box3 box;
    std::optional<DirectionCone> cone;
    double area = 0;
    const auto add = [&](std::uint32_t triangle) {
        const double own_area = geometry.triangle_area(shape, triangle);
        if (!(own_area > 0)) return;
        area += own_area;
        // Normals may be turned towards the shading normals, which vary within the triangle.
        for (const Vec2& b : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1.0f / 3)}) {
            const Hit corner = geometry.triangle_point(shape, triangle, b.x, b.y);
            box.extendBy(corner.p);
            const DirectionCone normal{corner.ng, 0.0f};
            cone = cone ? joined(*cone, normal) : normal;
        }
    };
    if (patches.count() > 0)
        for (const std::uint32_t triangle : patches.triangles(patch))
            add(triangle);
    else
        for (std::uint32_t triangle = 0; triangle < geometry.triangle_count(shape); ++triangle)
            add(triangle);
    if (!cone) return LightBounds::in_box(Box3(Vec3(0.0f), Vec3(0.0f)), 0.0);
    LightBounds bounds = LightBounds::in_box(box, mean * area);
    bounds.cone = *cone;
    return bounds;
}

Hit AreaLight::point(const LightScene& scene, const Draw& random, float& density) const {
    const Vec2 u = {to_unit(random[2]), to_unit(random[3])};
    std::uint32_t triangle = 0;
    Hit hit;
    if (sphere) {
        const Vec3 normal = normalize(square_to_sphere(u));
        hit = sphere_hit(*sphere, sphere->center + normal * sphere->radius, normal);
        hit.shape = shape;
    } else if (scene.geometry->triangle_count(shape) > 0) {
        triangle = triangles.pick(random[1]);
        const Vec2 b = square_to_triangle(u);
        scene.geometry->set_triangle_point(hit, shape, triangle, b.x, b.y);
    } else {
        hit = uniform_point(*scene.geometry, shape, u);
    }
    density = point_density(triangle);
    return hit;
}

Rgb AreaLight::radiance_at(const LightScene& scene, const Hit& hit) const {
    const Rgb emitted = texture != kNone ? textured(scene, hit).rgb() : radiance;
    return mask ? emitted * scene.geometry->opacity(hit) : emitted;
}

AreaLight::Channels AreaLight::textured(const LightScene& scene, const Hit& hit) const {
    const MeshPoint on_mesh = scene.textures->reads_meshes() ? scene.geometry->mesh_point(hit) : MeshPoint();
    const Rgb c = radiance * scene.textures->color(texture, {scene.geometry->uv(hit), &on_mesh});
    return {c.x, c.y, c.z};
}

}  // namespace treefarm
