// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/lint/emitter_points.h"

#include <cmath>

#include "common/scene/uses/emitter_uses.h"

namespace treefarm::linting {

using Imath::V3d;

std::array<double, 2> point_of_square(int i) {
    const double a = 0.5 + i * 0.7548776662466927, b = 0.5 + i * 0.5698402909980532;
    return {a - std::floor(a), b - std::floor(b)};
}

V3d direction_of_sphere(double u, double v) {
    const double z = 1 - 2 * u, r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(2 * M_PI * v), r * std::sin(2 * M_PI * v), z};
}

V3d direction_of_hemisphere(const V3d& axis, double u, double v) {
    const V3d d = axis + direction_of_sphere(u, v) * 0.999;
    return d.normalized();
}

V3d direction_of_cone(const LightCone& cone, double u, double v) {
    if (!(cone.half_angle < kPi)) return direction_of_sphere(u, v);
    const double spread = 0.9 * std::tan(std::min(double(cone.half_angle), 1.5)) * std::sqrt(u);
    const V3d axis(cone.axis), side = axis.cross(std::abs(axis.x) < 0.9 ? V3d(1, 0, 0) : V3d(0, 1, 0));
    const V3d x = side.normalized(), y = axis.cross(x);
    return (axis + (x * std::cos(2 * M_PI * v) + y * std::sin(2 * M_PI * v)) * spread).normalized();
}

std::pair<V3d, V3d> camera_ray(const Scene& scene, double u, double v) {
    const Camera& camera = scene.camera;
    const Film& film = scene.film;
    const double x = (film.crop.x + u * film.width) / film.whole_width();
    const double y = (film.crop.y + v * film.height) / film.whole_height();
    const V3d point = V3d(camera.corner) + V3d(camera.across) * x + V3d(camera.down) * y, origin(camera.origin);
    if (camera.panoramic)
        return {origin, V3d(camera.panorama_direction(static_cast<float>(x), static_cast<float>(y))).normalized()};
    if (camera.is_orthographic()) return {origin + point, V3d(camera.parallel)};
    return {origin, point.normalized()};
}

namespace {

constexpr std::size_t kMostEmitters = 16;  ///< limit of examined emitters: a scene with more is hardly black by mistake
constexpr std::size_t kMostTriangles = 5'000'000;  ///< limit of triangles that rays are tested against

// Point number i of a surface, from (u, v) in the unit square: an overload for each kind of shape.

/// A point on one of the triangles.
std::optional<SurfacePoint> point_of(const Mesh& mesh, int i, double u, double v) {
    if (mesh.triangle_count() == 0) return std::nullopt;
    const std::uint32_t* corner = &mesh.indices[3 * (static_cast<std::size_t>(i) * 7919 % mesh.triangle_count())];
    const V3d a(mesh.positions[corner[0]]), ab = V3d(mesh.positions[corner[1]]) - a,
                                            ac = V3d(mesh.positions[corner[2]]) - a;
    V3d normal = ab.cross(ac);
    if (!(normal.length() > 0)) return std::nullopt;
    if (!mesh.normals.empty() && normal.dot(V3d(mesh.normals[corner[0]])) < 0) normal = -normal;
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return SurfacePoint(a + ab * u + ac * v, normal.normalized());
}

std::optional<SurfacePoint> point_of(const Sphere& sphere, int, double u, double v) {
    const V3d out = direction_of_sphere(u, v);
    return SurfacePoint(V3d(sphere.center) + out * double(sphere.radius), sphere.flip_normals ? -out : out);
}

std::optional<SurfacePoint> point_of(const Disk& disk, int, double u, double v) {
    const V3d a(disk.half_u), b(disk.half_v);
    return SurfacePoint(V3d(disk.center) + (a * (2 * u - 1) + b * (2 * v - 1)) * 0.7, a.cross(b).normalized());
}

std::optional<SurfacePoint> point_of(const Cylinder& cylinder, int, double u, double v) {
    const V3d axis(normalize(cylinder.p1 - cylinder.p0)), x(cylinder.meridian), y = axis.cross(x);
    const V3d out = x * std::cos(2 * M_PI * u) + y * std::sin(2 * M_PI * u);
    return SurfacePoint(V3d(cylinder.p0) + V3d(cylinder.p1 - cylinder.p0) * v + out * double(cylinder.radius),
                        cylinder.flip_normals ? -out : out);
}

std::optional<SurfacePoint> point_of(const Instance&, int, double, double) {
    return std::nullopt;
}

}  // namespace

std::optional<SurfacePoint> point_on(const Shape& shape, int i, double u, double v) {
    return std::visit([&](const auto& kind) { return point_of(kind, i, u, v); }, shape.geometry);
}

bool can_be_looked_at(const Scene& scene) {
    if (scene.shapes.empty() || scene.emitters.size() > kMostEmitters || scene.triangle_count() > kMostTriangles)
        return false;
    const auto known = [](std::int32_t i, std::size_t count) {
        return i == kNone || (i >= 0 && static_cast<std::size_t>(i) < count);
    };
    for (const Shape& shape : scene.shapes) {
        if (!known(shape.material, scene.materials.size()) ||
            !known(shape.group, static_cast<std::size_t>(scene.group_count)))
            return false;
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
            if (!mesh->normals.empty() && mesh->normals.size() != mesh->positions.size()) return false;
            for (const std::uint32_t i : mesh->indices)
                if (i >= mesh->positions.size()) return false;
        }
        if (const auto* instance = std::get_if<Instance>(&shape.geometry))
            if (instance->group == kNone || !known(instance->group, static_cast<std::size_t>(scene.group_count)))
                return false;
        const Box3 box = own_box(shape);
        if (!box.isEmpty() && (!is_finite(box.min) || !is_finite(box.max))) return false;
    }
    for (const Emitter& emitter : scene.emitters)
        if (emitter.type() == LightType::area)
            if (const std::int32_t shape = shape_of(emitter); shape == kNone || !known(shape, scene.shapes.size()))
                return false;
    return is_finite(scene.camera.origin) && is_finite(scene.camera.corner);
}

}  // namespace treefarm::linting
