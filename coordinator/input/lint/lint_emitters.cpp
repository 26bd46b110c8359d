// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "common/scene/kinds/shape_area.h"
#include "common/scene/uses/emitter_uses.h"
#include "coordinator/input/lint/lint.h"

namespace treefarm::linting {
namespace {

using enum Finding::Severity;
using Imath::V3d;

/// A plane to one side of which an emitter emits.
struct Front {
    V3d point, normal;
};

/// Whether a point is before the plane, by more than rounding.
bool before(const Front& front, const V3d& p) {
    const V3d d = p - front.point;
    return d.dot(front.normal) > 1e-6 * (d.length() + 1e-6 * p.length());
}

/// Front planes of a flat emitter; empty for emitters that face all directions, or have no area. Each kind of shape
/// needs an overload.
std::vector<Front> fronts_of(const Mesh& mesh) {
    std::vector<Front> fronts;
    for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
        const V3d a(mesh.positions[mesh.indices[3 * t]]), b(mesh.positions[mesh.indices[3 * t + 1]]),
            c(mesh.positions[mesh.indices[3 * t + 2]]);
        V3d normal = (b - a).cross(c - a);
        const double twice = normal.length();
        if (!(twice > 0)) continue;
        if (!mesh.normals.empty() && normal.dot(V3d(mesh.normals[mesh.indices[3 * t]])) < 0) normal = -normal;
        fronts.push_back({a, normal * (1.0 / twice)});
    }
    return fronts;
}

std::vector<Front> fronts_of(const Disk& disk) {
    const V3d normal = V3d(disk.half_u).cross(V3d(disk.half_v));
    if (!(normal.length() > 0)) return {};
    return {{V3d(disk.center), normal.normalized()}};
}

std::vector<Front> fronts_of(const Sphere&) {
    return {};
}

std::vector<Front> fronts_of(const Cylinder&) {
    return {};
}

std::vector<Front> fronts_of(const Instance&) {
    return {};
}

/// Whether a part of the scene, or the camera, is before one of the planes, judged by the corners of boxes.
bool reaches_anything(const Scene& scene, const Shape& own, const std::vector<Front>& fronts) {
    const auto lit = [&](const V3d& p) {
        return std::any_of(fronts.begin(), fronts.end(), [&](const Front& front) { return before(front, p); });
    };
    if (lit(V3d(scene.camera.origin))) return true;
    for (const Shape& shape : scene.shapes) {
        if (std::holds_alternative<Instance>(shape.geometry)) return true;  // not examined
        // Every vertex of the emitter itself: one that is not convex lights itself.
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry); mesh && &shape == &own) {
            if (std::any_of(mesh->positions.begin(), mesh->positions.end(), [&](const Vec3& p) { return lit(V3d(p)); }))
                return true;
            continue;
        }
        const Box3 box = own_box(shape);
        if (box.isEmpty()) continue;
        for (int corner = 0; corner < 8; ++corner)
            if (lit(V3d(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                        corner & 4 ? box.max.z : box.min.z)))
                return true;
    }
    return false;
}

/// Whether light within a cone may hit something, judged by spheres around the boxes of meshes; other shapes count as
/// hit.
bool may_hit_anything(const Scene& scene, const LightCone& cone) {
    if (!(cone.half_angle < kPi)) return true;
    return std::any_of(scene.shapes.begin(), scene.shapes.end(), [&](const Shape& shape) {
        if (!std::holds_alternative<Mesh>(shape.geometry)) return true;
        const Box3 box = own_box(shape);
        const double radius = 0.5 * (V3d(box.max) - V3d(box.min)).length();
        const V3d d = (V3d(box.min) + V3d(box.max)) * 0.5 - V3d(cone.apex);
        const double distance = d.length();
        if (distance <= radius) return true;
        const double angle = std::acos(std::clamp(d.dot(V3d(cone.axis)) / distance, -1.0, 1.0));
        return angle - std::asin(radius / distance) <= double(cone.half_angle);
    });
}

class EmitterLint : public IgnoreFields {
  public:
    EmitterLint(const Scene& scene, const Emitter& emitter, std::vector<Finding>& findings)
        : scene_(scene), emitter_(emitter), findings_(findings) {}

    void run() {
        visit_fields(emitter_.kind, *this);
        const auto cone = cone_of(emitter_);
        if (cone && !scene_.shapes.empty() && !may_hit_anything(scene_, *cone))
            add(warning, "unreachable emitter",
                std::string("the ") + emitter_.traits().effect + "'s cone meets nothing of the scene", "turn it");
    }

    void light(const char* what, const Rgb& value) {
        if (!is_finite(value) || value.x < 0.0f || value.y < 0.0f || value.z < 0.0f)
            add(error, "numbers", std::string("the emitter's ") + what + " is negative or not finite",
                "give values of 0 or more");
        else if (is_black(value))
            add(warning, "black emitter",
                std::string("the emitter's ") + what + " is 0: it costs samples and gives no light", "remove it");
    }
    void light(const char* what, const ColorInput& input) { light(what, input.value); }
    void light(const char* what, float value) { light(what, Rgb(value)); }

    void shape(std::int32_t index) {
        if (index < 0 || static_cast<std::size_t>(index) >= scene_.shapes.size()) return;
        const Shape& shape = scene_.shapes[static_cast<std::size_t>(index)];
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry))
            for (const std::uint32_t i : mesh->indices)
                if (i >= mesh->positions.size()) return;
        const std::vector<Front> fronts = std::visit([](const auto& kind) { return fronts_of(kind); }, shape.geometry);
        if (!(area_of(shape.geometry) > 0))
            return add(error, "zero-area emitter", named("shape", shape.name) + " emits, but has no area",
                       "repair or remove it");
        // Large meshes face all directions; only flat ones are likely to be reversed.
        if (!fronts.empty() && fronts.size() <= 1000 && !reaches_anything(scene_, shape, fronts))
            add(warning, "unreachable emitter",
                named("shape", shape.name) + " emits to a side on which there is nothing, not even the camera",
                "turn it round");
    }

  private:
    void add(Finding::Severity severity, const char* kind, const std::string& what, const std::string& cure) {
        findings_.push_back({severity, kind, emitter_.where, what, cure});
    }

    const Scene& scene_;
    const Emitter& emitter_;
    std::vector<Finding>& findings_;
};

}  // namespace

void lint_emitters(const Scene& scene, std::vector<Finding>& findings) {
    for (const Emitter& emitter : scene.emitters)
        EmitterLint(scene, emitter, findings).run();
}

}  // namespace treefarm::linting
