// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/lint/first_hit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace treefarm {
namespace {

using Imath::V3d;

struct Ray {
    V3d origin, direction;  ///< not of length 1 within instances
    double nearest = std::numeric_limits<double>::infinity();
    bool behind = false;  ///< nearest hit so far is from behind
    V3d normal;           ///< of the nearest hit so far

    bool take_if_nearer(double t, const V3d& n) {
        if (!(t > 0 && t < nearest)) return false;
        nearest = t;
        behind = direction.dot(n) > 0;
        normal = n;
        return true;
    }
};

bool misses(const Ray& ray, const Box3& box) {
    double enter = 0, leave = ray.nearest;
    for (int i = 0; i < 3; ++i) {
        const double low = double(box.min[i]) - ray.origin[i], high = double(box.max[i]) - ray.origin[i];
        if (ray.direction[i] == 0) {
            if (low > 0 || high < 0) return true;
            continue;
        }
        const double a = low / ray.direction[i], b = high / ray.direction[i];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter > leave * (1 + 1e-9);
}

bool intersect(Ray& ray, const Mesh& mesh) {
    bool is_hit = false;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
        const std::uint32_t* corner = &mesh.indices[3 * t];
        const V3d a(mesh.positions[corner[0]]), ab = V3d(mesh.positions[corner[1]]) - a,
                                                ac = V3d(mesh.positions[corner[2]]) - a;
        const V3d p = ray.direction.cross(ac);
        const double determinant = ab.dot(p);
        if (determinant == 0) continue;
        const V3d from = ray.origin - a, q = from.cross(ab);
        const double u = from.dot(p) / determinant, v = ray.direction.dot(q) / determinant;
        if (u < 0 || v < 0 || u + v > 1) continue;
        V3d normal = ab.cross(ac);
        if (!mesh.normals.empty() && normal.dot(V3d(mesh.normals[corner[0]])) < 0) normal = -normal;
        is_hit |= ray.take_if_nearer(ac.dot(q) / determinant, normal);
    }
    return is_hit;
}

/// Intersects with the roots of a t^2 + 2 b t + c.
bool intersect_round(Ray& ray, double a, double b, double c, auto normal_at) {
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0) || a == 0) return false;
    const double root = std::sqrt(discriminant);
    bool is_hit = false;
    for (const double t : {(-b - root) / a, (-b + root) / a})
        if (const std::optional<V3d> normal = normal_at(ray.origin + ray.direction * t))
            is_hit |= ray.take_if_nearer(t, *normal);
    return is_hit;
}

bool intersect(Ray& ray, const Sphere& sphere) {
    const V3d from = ray.origin - V3d(sphere.center);
    const auto radius = double(sphere.radius);
    return intersect_round(ray, ray.direction.dot(ray.direction), ray.direction.dot(from),
                           from.dot(from) - radius * radius, [&](const V3d& p) -> std::optional<V3d> {
                               return (p - V3d(sphere.center)) * (sphere.flip_normals ? -1.0 : 1.0);
                           });
}

bool intersect(Ray& ray, const Cylinder& cylinder) {
    const V3d p0(cylinder.p0), along = V3d(cylinder.p1) - p0, axis = along.normalized(), from = ray.origin - p0;
    const V3d d = ray.direction - axis * ray.direction.dot(axis), f = from - axis * from.dot(axis);
    const auto radius = double(cylinder.radius);
    return intersect_round(ray, d.dot(d), d.dot(f), f.dot(f) - radius * radius,
                           [&](const V3d& p) -> std::optional<V3d> {
                               const double height = (p - p0).dot(axis);
                               if (height < 0 || height > along.length()) return std::nullopt;
                               return (p - p0 - axis * height) * (cylinder.flip_normals ? -1.0 : 1.0);
                           });
}

bool intersect(Ray& ray, const Disk& disk) {
    const V3d u(disk.half_u), v(disk.half_v), normal = u.cross(v);
    const double slope = ray.direction.dot(normal);
    if (slope == 0) return false;
    const double t = (V3d(disk.center) - ray.origin).dot(normal) / slope;
    const V3d p = ray.origin + ray.direction * t - V3d(disk.center);
    const double a = p.cross(v).dot(normal) / normal.dot(normal), b = u.cross(p).dot(normal) / normal.dot(normal);
    return a * a + b * b <= 1 && ray.take_if_nearer(t, normal);
}

bool intersect(Ray&, const Instance&) {
    return false;
}

}  // namespace

FirstHitSearch::FirstHitSearch(const Scene& scene) : scene_(scene) {
    for (const Shape& shape : scene.shapes) {
        boxes_.push_back(own_box(shape));
        const auto* instance = std::get_if<Instance>(&shape.geometry);
        from_world_.push_back(instance ? Imath::M44d(instance->to_world).inverse() : Imath::M44d());
    }
}

std::optional<FirstHit> FirstHitSearch::find(const V3d& origin, const V3d& direction) const {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    std::optional<FirstHit> hit;
    const auto try_shape = [&](Ray& in_its_space, std::size_t i) {
        if (boxes_[i].isEmpty() || misses(in_its_space, boxes_[i])) return;
        if (std::visit([&](const auto& geometry) { return intersect(in_its_space, geometry); },
                       scene_.shapes[i].geometry))
            hit = FirstHit{in_its_space.nearest, i, in_its_space.behind, in_its_space.normal};
    };
    for (std::size_t i = 0; i < scene_.shapes.size(); ++i) {
        const Shape& shape = scene_.shapes[i];
        const auto* instance = std::get_if<Instance>(&shape.geometry);
        if (!instance) {
            if (shape.group == kNone) try_shape(ray, i);
            continue;
        }
        Ray moved = ray;  // distances stay equal: the direction scales with the space
        from_world_[i].multVecMatrix(origin, moved.origin);
        from_world_[i].multDirMatrix(direction, moved.direction);
        for (std::size_t part = 0; part < scene_.shapes.size(); ++part)
            if (scene_.shapes[part].group == instance->group) try_shape(moved, part);
        if (moved.nearest < ray.nearest) from_world_[i].transposed().multDirMatrix(moved.normal, hit->normal);
        ray.nearest = moved.nearest;
    }
    return hit;
}

}  // namespace treefarm
