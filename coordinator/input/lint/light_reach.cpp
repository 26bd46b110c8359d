// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/lint/light_reach.h"

#include <cmath>
#include <optional>
#include <utility>

#include "common/scene/kinds/shape_area.h"
#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/material_traits.h"
#include "coordinator/input/lint/emitter_points.h"
#include "coordinator/input/lint/first_hit.h"

namespace treefarm {
namespace {

using Imath::V3d;
using linting::point_of_square;

constexpr int kColumns = 12, kRows = 8;  ///< grid of the camera's rays
constexpr int kPoints = 2;               ///< points of each emitter per camera ray
constexpr int kMostPanes = 8;            ///< panes of glass that a camera ray passes
constexpr double kNearly = 1 - 1e-3;     ///< part of the way to an emitter: a hit beyond it is the emitter
constexpr double kStep = 1e-5;           ///< offset from a surface, over the scene's size

bool is_flat(const Shape& shape) {
    const auto* const mesh = std::get_if<Mesh>(&shape.geometry);
    return mesh ? mesh->triangle_count() <= 2 : std::holds_alternative<Disk>(shape.geometry);
}

class Looking {
  public:
    explicit Looking(const Scene& scene)
        : scene_(scene), search_(scene), box_(scene.bounds()), size_((V3d(box_.max) - V3d(box_.min)).length()) {}

    LightReach look() {
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column) {
                const auto [origin, direction] =
                    linting::camera_ray(scene_, (column + 0.5) / kColumns, (row + 0.5) / kRows);
                if (const auto seen = seen_from(origin, direction)) from(*seen, row * kColumns + column);
            }
        const double local = reach_.free + reach_.glass + reach_.blocked, all = local + reach_.infinity;
        reach_.known = all > 0;
        if (!reach_.known) return reach_;
        reach_.infinity /= all;
        for (double* part : {&reach_.free, &reach_.glass, &reach_.blocked})
            *part = local > 0 ? *part / local : 0.0;
        return reach_;
    }

  private:
    bool is_glass(std::size_t shape) const {
        const std::int32_t material = scene_.shapes[shape].material;
        return material != kNone && material_traits(scene_, material).lobes.delta_transmission;
    }

    /// Point just before the first surface on a ray that passes smooth glass straight.
    std::optional<V3d> seen_from(V3d origin, const V3d& direction) const {
        for (int panes = 0; panes < kMostPanes; ++panes) {
            const auto hit = search_.find(origin, direction);
            if (!hit) return std::nullopt;
            if (!is_glass(hit->shape)) return origin + direction * (hit->distance - kStep * size_);
            origin += direction * (hit->distance + kStep * size_);
        }
        return std::nullopt;
    }

    /// Adds the light that arrives at a point.
    void from(const V3d& p, int ray) {
        const LightReach before = std::exchange(reach_, {});
        const LitScene lit{static_cast<float>(0.25 * size_ * size_), scene_.images};
        for (const Emitter& emitter : scene_.emitters) {
            const double scale =
                std::visit([&](const auto& kind) { return double(kind.radiance_scale(lit)); }, emitter.kind);
            const std::int32_t shape = shape_of(emitter);
            const std::optional<LightCone> cone = cone_of(emitter);
            if (shape != kNone)
                to_surface(p, scene_.shapes[static_cast<std::size_t>(shape)], scale, ray);
            else if (cone)
                add(p, V3d(cone->apex), scale * 0.25 * size_ * size_);
            else
                reach_.infinity += scale * M_PI;
        }
        // Points have equal weight: otherwise one beside a lamp would dominate.
        const double all = reach_.infinity + reach_.free + reach_.glass + reach_.blocked, scale = all > 0 ? 1 / all : 0;
        reach_.infinity = before.infinity + reach_.infinity * scale;
        reach_.free = before.free + reach_.free * scale;
        reach_.glass = before.glass + reach_.glass * scale;
        reach_.blocked = before.blocked + reach_.blocked * scale;
    }

    void to_surface(const V3d& p, const Shape& lamp, double radiance, int ray) {
        for (int i = 0; i < kPoints; ++i) {
            const auto [u, v] = point_of_square(kPoints * ray + i);
            const auto point = linting::point_on(lamp, kPoints * ray + i, u, v);
            if (!point) continue;
            const V3d way = p - point->first;
            const double cosine = way.dot(point->second) / way.length();
            const double light = radiance * area_of(lamp.geometry) * std::abs(cosine) / (kPoints * way.dot(way));
            if (cosine > 0)
                add(p, point->first, light);
            else if (is_flat(lamp))
                reach_.blocked += light;  // another point of a closed surface faces this way
        }
    }

    void add(const V3d& p, const V3d& to, double light) {
        if (!std::isfinite(light)) return;
        const V3d way = to - p;
        const double distance = way.length();
        const auto hit = search_.find(p, way / distance);
        if (!hit || hit->distance >= kNearly * distance) {
            reach_.free += light;
            return;
        }
        (is_glass(hit->shape) ? reach_.glass : reach_.blocked) += light;
    }

    const Scene& scene_;
    const FirstHitSearch search_;
    const Box3 box_;
    const double size_;
    LightReach reach_;
};

}  // namespace

LightReach light_reach(const Scene& scene) {
    return linting::can_be_looked_at(scene) ? Looking(scene).look() : LightReach();
}

}  // namespace treefarm
