// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/lint/hidden_lights.h"

#include <algorithm>
#include <cmath>

#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/material_traits.h"
#include "coordinator/input/lint/emitter_points.h"

namespace treefarm::linting {

using Imath::V3d;

HiddenLights::HiddenLights(const Scene& scene, const FirstHitSearch& search) : scene_(scene), search_(search) {}

/// Whether a shape reflects and transmits in single directions only.
bool HiddenLights::is_smooth(std::size_t shape, bool& transmits) const {
    const std::int32_t material = scene_.shapes[shape].material;
    if (material == kNone) return false;
    const MaterialTraits traits = material_traits(scene_, material);
    transmits = traits.lobes.delta_transmission;
    return traits.lobes.delta() && !traits.lobes.smooth() && !traits.lobes.null && !traits.masked;
}

/// Follows a ray straight through smooth glass and off mirrors.
std::optional<HiddenLights::End> HiddenLights::follow(V3d origin, V3d direction) const {
    for (int passed = 0; passed < kMostSmooth; ++passed) {
        const auto hit = search_.find(origin, direction);
        if (!hit) return std::nullopt;
        bool transmits = false;
        if (!is_smooth(hit->shape, transmits)) return End{origin + direction * (hit->distance - kStep * size_), passed};
        origin += direction * hit->distance;
        if (!transmits) {
            const V3d n = hit->normal.normalized();
            direction = (direction - n * (2.0 * direction.dot(n))).normalized();
        }
        origin += direction * (kStep * size_);
    }
    return std::nullopt;
}

void HiddenLights::look() {
    looked_ = true;
    const Box3 box = scene_.bounds();
    size_ = (V3d(box.max) - V3d(box.min)).length();
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const auto [origin, direction] = camera_ray(scene_, (column + 0.5) / kColumns, (row + 0.5) / kRows);
            if (const auto end = follow(origin, direction)) seen_.push_back(end->point);
        }
}

HiddenLights::Way HiddenLights::way(const V3d& p, const Emitter& emitter) const {
    V3d to;
    double distance = std::numeric_limits<double>::infinity();
    if (const auto cone = cone_of(emitter)) {
        to = V3d(cone->apex) - p;
        distance = to.length();
        to /= distance;
        if (cone->half_angle < kPi && -to.dot(V3d(cone->axis)) < std::cos(double(cone->half_angle))) return Way::closed;
    } else {
        to = -V3d(std::get<DirectionalEmitter>(emitter.kind).direction);
    }
    const auto hit = search_.find(p, to);
    if (!hit || hit->distance >= distance * (1.0 - 1e-6)) return Way::open;
    bool transmits = false;
    if (is_smooth(hit->shape, transmits)) return transmits ? Way::glass : Way::closed;
    const std::int32_t material = scene_.shapes[hit->shape].material;
    const MaterialTraits traits = material == kNone ? MaterialTraits{} : material_traits(scene_, material);
    return traits.masked || traits.lobes.null ? Way::open : Way::closed;
}

/// Whether all of the emitter's light meets smooth surfaces first, and some of it then comes to what the camera sees.
bool HiddenLights::comes_by_mirrors(const Emitter& emitter) const {
    const auto cone = cone_of(emitter);
    if (!cone) return false;
    bool comes = false;
    for (int i = 0; i < kLightRays; ++i) {
        const auto [u, v] = point_of_square(i);
        const auto end = follow(V3d(cone->apex), direction_of_cone(*cone, u, v));
        if (!end) continue;
        if (end->passed == 0) return false;
        comes = comes || std::any_of(seen_.begin(), seen_.end(),
                                     [&](const V3d& p) { return (p - end->point).length() < kNear * size_; });
    }
    return comes;
}

void HiddenLights::judge(const Emitter& emitter, std::vector<Finding>& findings) {
    if (emitter.type() != LightType::delta) return;
    if (!looked_) look();
    bool by_glass = false;
    for (const V3d& p : seen_) {
        const Way found = way(p, emitter);
        if (found == Way::open) return;
        by_glass = by_glass || found == Way::glass;
    }
    if (!by_glass && (seen_.empty() || !comes_by_mirrors(emitter))) return;
    findings.push_back(
        {Finding::Severity::warning, by_glass ? "light behind glass" : "light by mirrors", emitter.where,
         std::string("this emitter's light reaches what the camera sees ") +
             (by_glass ? "through smooth glass" : "by mirrors") +
             " alone, where a light without extent cannot be found",
         by_glass ? "make it an area emitter, or the glass rough" : "make it an area emitter, or the mirrors rough"});
}

}  // namespace treefarm::linting
