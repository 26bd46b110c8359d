// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "common/scene/lint/first_hit.h"
#include "common/scene/lint/lint.h"
#include "common/scene/model/material_traits.h"
#include "common/scene/uses/emitter_uses.h"

namespace treefarm::linting {
namespace {

using enum Finding::Severity;
using Imath::V3d;

constexpr int kColumns = 12, kRows = 8;            ///< of the camera's rays
constexpr int kLightRays = 32;                     ///< of an emitter
constexpr std::size_t kMostEmitters = 16;          ///< that are looked at: a scene with more is hardly black by mistake
constexpr std::size_t kMostTriangles = 5'000'000;  ///< that rays are held against
/// Distance from an emitter, as a share of the scene's size, below which a thing covers it.
constexpr double kClose = 1e-3;

/// A low-discrepancy point of the unit square (Roberts 2018), the same every time.
std::array<double, 2> point_of_square(int i) {
    const double a = 0.5 + i * 0.7548776662466927, b = 0.5 + i * 0.5698402909980532;
    return {a - std::floor(a), b - std::floor(b)};
}

V3d direction_of_sphere(double u, double v) {
    const double z = 1 - 2 * u, r = std::sqrt(std::max(0.0, 1 - z * z));
    return {r * std::cos(2 * M_PI * v), r * std::sin(2 * M_PI * v), z};
}

/// A direction about the axis, cosine-distributed.
V3d direction_of_hemisphere(const V3d& axis, double u, double v) {
    const V3d d = axis + direction_of_sphere(u, v) * 0.999;
    return d.normalized();
}

/// A direction within a cone.
V3d direction_of_cone(const LightCone& cone, double u, double v) {
    if (!(cone.half_angle < kPi)) return direction_of_sphere(u, v);
    const double spread = 0.9 * std::tan(std::min(double(cone.half_angle), 1.5)) * std::sqrt(u);
    const V3d axis(cone.axis), side = axis.cross(std::abs(axis.x) < 0.9 ? V3d(1, 0, 0) : V3d(0, 1, 0));
    const V3d x = side.normalized(), y = axis.cross(x);
    return (axis + (x * std::cos(2 * M_PI * v) + y * std::sin(2 * M_PI * v)) * spread).normalized();
}

/// A point of a surface with its normal.
using SurfacePoint = std::pair<V3d, V3d>;

// Number i of a surface's points, drawn by (u, v) of the unit square: an overload for each kind of shape, or it does
// not compile.

/// A point of some triangle.
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

std::optional<SurfacePoint> point_on(const Shape& shape, int i, double u, double v) {
    return std::visit([&](const auto& kind) { return point_of(kind, i, u, v); }, shape.geometry);
}

/// Counts of what some rays met.
struct HitCounts {
    int rays = 0, hits = 0;
    int behind = 0;  ///< backs that reflect nothing
    int glass = 0;   ///< smooth, transmitting surfaces
    int close = 0;
    int inside = 0;  ///< backs of whatever kind
    std::size_t shape = 0;
    bool one_shape = true;  ///< `shape` is all that was hit

    bool all(int count) const { return hits > 0 && count == hits; }
};

class Darkness {
  public:
    Darkness(const Scene& scene, std::vector<Finding>& findings)
        : scene_(scene), findings_(findings), search_(scene), box_(scene.bounds()) {}

    void look() {
        const bool surrounded = scene_.environment() != kNone;
        std::vector<HitCounts> lights;
        for (const Emitter& emitter : scene_.emitters)
            lights.push_back(from_emitter(emitter));
        for (std::size_t i = 0; i < lights.size(); ++i)
            judge_emitter(scene_.emitters[i], lights[i]);
        const HitCounts seen = from_camera();
        if (seen.hits < seen.rays && surrounded) return;
        if (seen.hits == 0)
            return add(warning, "nothing in view", {}, "no ray of the camera meets anything",
                       "turn or move the camera");
        const Shape& first = scene_.shapes[seen.shape];
        if (seen.all(seen.behind))
            return add(warning, "seen from behind", first.where,
                       "the camera sees only backs of one-sided surfaces, as of " + named("shape", first.name) +
                           ", which reflect nothing",
                       "turn their normals round, or put their BSDF into <bsdf type=\"twosided\">");
        const auto reaches = [&](const HitCounts& light) { return light.inside > 0 || light.rays == 0; };
        if (seen.all(seen.inside) && seen.one_shape && seen.hits == seen.rays && !surrounded &&
            std::none_of(lights.begin(), lights.end(), reaches))
            add(warning, "camera inside", first.where,
                "the camera is inside " + named("shape", first.name) + ", and none of " + std::to_string(kLightRays) +
                    " rays of each emitter meets it there",
                "move the camera or an emitter");
    }

  private:
    void add(Finding::Severity severity, const char* kind, const Location& where, const std::string& what,
             const std::string& cure) {
        findings_.push_back({severity, kind, where, what, cure});
    }

    MaterialTraits traits(const Shape& shape) const {
        return shape.material == kNone ? MaterialTraits{} : material_traits(scene_, shape.material);
    }

    void cast(const V3d& origin, const V3d& direction, HitCounts& counts) const {
        const auto hit = search_.find(origin, direction);
        ++counts.rays;
        if (!hit) return;
        const Shape& shape = scene_.shapes[hit->shape];
        const MaterialTraits t = traits(shape);
        counts.one_shape = counts.one_shape && (counts.hits == 0 || counts.shape == hit->shape);
        counts.shape = hit->shape;
        ++counts.hits;
        const bool is_open = t.masked || t.lobes.transmits();
        counts.inside += hit->behind && !is_open ? 1 : 0;
        counts.behind += hit->behind && !is_open && !t.twosided ? 1 : 0;
        counts.glass +=
            t.lobes.delta_transmission && !t.lobes.glossy_transmission && !t.lobes.null && !t.masked ? 1 : 0;
        counts.close += !is_open && hit->distance < kClose * double((box_.max - box_.min).length()) ? 1 : 0;
    }

    HitCounts from_camera() const {
        HitCounts counts;
        const Camera& camera = scene_.camera;
        const Film& film = scene_.film;
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column) {
                const double x = (film.crop.x + (column + 0.5) / kColumns * film.width) / film.whole_width();
                const double y = (film.crop.y + (row + 0.5) / kRows * film.height) / film.whole_height();
                const V3d point = V3d(camera.corner) + V3d(camera.across) * x + V3d(camera.down) * y;
                if (camera.panoramic)
                    cast(V3d(camera.origin),
                         V3d(camera.panorama_direction(static_cast<float>(x), static_cast<float>(y))).normalized(),
                         counts);
                else if (camera.is_orthographic())
                    cast(V3d(camera.origin) + point, V3d(camera.parallel), counts);
                else
                    cast(V3d(camera.origin), point.normalized(), counts);
            }
        return counts;
    }

    /// What rays from an emitter meet; nothing for emitters that surround the scene.
    HitCounts from_emitter(const Emitter& emitter) const {
        HitCounts counts;
        const std::int32_t shape = shape_of(emitter);
        const std::optional<LightCone> cone = cone_of(emitter);
        for (int i = 0; i < kLightRays; ++i) {
            const auto [u, v] = point_of_square(i);
            const auto [s, t] = point_of_square(i + 1000);
            if (shape != kNone) {
                const auto point = point_on(scene_.shapes[static_cast<std::size_t>(shape)], i, u, v);
                if (!point) continue;
                const double step = 1e-6 * (point->first.length() + double((box_.max - box_.min).length()));
                cast(point->first + point->second * step, direction_of_hemisphere(point->second, s, t), counts);
            } else if (cone) {
                cast(V3d(cone->apex), direction_of_cone(*cone, u, v), counts);
            }
        }
        return counts;
    }

    void judge_emitter(const Emitter& emitter, const HitCounts& counts) {
        if (counts.hits == 0) return;
        const std::string first = named("shape", scene_.shapes[counts.shape].name);
        if (counts.all(counts.behind))
            return add(warning, "lights backs only", emitter.where,
                       "all light of this emitter meets backs of one-sided surfaces, as of " + first +
                           ", which reflect nothing",
                       "turn their normals round, or put their BSDF into <bsdf type=\"twosided\">");
        if (counts.all(counts.close))
            return add(warning, "covered emitter", emitter.where,
                       "all light of this emitter meets " + first + " right before it", "turn or move it");
        if (counts.hits == counts.rays && counts.all(counts.glass)) {
            if (emitter.type() != LightType::area)
                add(warning, "light behind glass", emitter.where,
                    "all light of this emitter meets smooth glass, which a light without extent cannot be found "
                    "through",
                    "make it an area emitter, or the glass rough");
            else
                add(note, "light behind glass", emitter.where,
                    "all light of this emitter meets smooth glass: paths find it only by chance", "");
        }
    }

    const Scene& scene_;
    std::vector<Finding>& findings_;
    const FirstHitSearch search_;
    const Box3 box_;
};

/// Everything that rays need exists and is finite.
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

}  // namespace

void lint_darkness(const Scene& scene, std::vector<Finding>& findings) {
    if (can_be_looked_at(scene)) Darkness(scene, findings).look();
}

}  // namespace treefarm::linting

namespace treefarm {

std::vector<Finding> dark_causes(const Scene& scene) {
    std::vector<Finding> findings;
    if (scene.emitters.empty())
        findings.push_back({Finding::Severity::warning, "no emitters", {}, "the scene has no emitters", "add one"});
    linting::lint_darkness(scene, findings);
    return findings;
}

}  // namespace treefarm
