// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/material_traits.h"
#include "coordinator/input/lint/emitter_points.h"
#include "coordinator/input/lint/first_hit.h"
#include "coordinator/input/lint/hidden_lights.h"
#include "coordinator/input/lint/lint.h"

namespace treefarm::linting {
namespace {

using enum Finding::Severity;
using Imath::V3d;

constexpr int kColumns = 12, kRows = 8;  ///< of the camera's rays
constexpr int kLightRays = 32;           ///< of an emitter
/// Distance from an emitter, relative to the scene's size, below which a surface covers it.
constexpr double kClose = 1e-3;

/// Counts of hits of some rays.
struct HitCounts {
    int rays = 0, hits = 0;
    int behind = 0;  ///< backs that reflect nothing
    int glass = 0;   ///< smooth, transmitting surfaces
    int close = 0;
    int inside = 0;  ///< backs of any kind
    int own = 0;     ///< on the shape that they come from
    std::size_t shape = 0;
    bool one_shape = true;  ///< whether all hits are of `shape`

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
        HiddenLights hidden(scene_, search_);
        for (std::size_t i = 0; i < lights.size(); ++i) {
            const std::size_t found = findings_.size();
            judge_emitter(scene_.emitters[i], lights[i]);
            if (found == findings_.size()) hidden.judge(scene_.emitters[i], findings_);
        }
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

    void cast(const V3d& origin, const V3d& direction, HitCounts& counts, std::int32_t from = kNone) const {
        const auto hit = search_.find(origin, direction);
        ++counts.rays;
        if (!hit) return;
        const Shape& shape = scene_.shapes[hit->shape];
        const MaterialTraits t = traits(shape);
        counts.one_shape = counts.one_shape && (counts.hits == 0 || counts.shape == hit->shape);
        counts.shape = hit->shape;
        ++counts.hits;
        counts.own += static_cast<std::int64_t>(hit->shape) == from ? 1 : 0;
        const bool is_open = t.masked || t.lobes.transmits();
        counts.inside += hit->behind && !is_open ? 1 : 0;
        counts.behind += hit->behind && !is_open && !t.twosided ? 1 : 0;
        counts.glass +=
            t.lobes.delta_transmission && !t.lobes.glossy_transmission && !t.lobes.null && !t.masked ? 1 : 0;
        counts.close += !is_open && hit->distance < kClose * double((box_.max - box_.min).length()) ? 1 : 0;
    }

    HitCounts from_camera() const {
        HitCounts counts;
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column) {
                const auto [origin, direction] = camera_ray(scene_, (column + 0.5) / kColumns, (row + 0.5) / kRows);
                cast(origin, direction, counts);
            }
        return counts;
    }

    /// Hits of rays from an emitter; none for emitters that surround the scene.
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
                cast(point->first + point->second * step, direction_of_hemisphere(point->second, s, t), counts, shape);
            } else if (cone) {
                cast(V3d(cone->apex), direction_of_cone(*cone, u, v), counts);
            }
        }
        return counts;
    }

    void judge_emitter(const Emitter& emitter, const HitCounts& counts) {
        if (counts.hits == 0) return;
        const std::string first = named("shape", scene_.shapes[counts.shape].name);
        if (counts.hits == counts.rays && counts.all(counts.own) && is_alone_inside(scene_.shapes[counts.shape]))
            return add(warning, "inside-out emitter", emitter.where,
                       "the light of " + first + " stays inside it: it is mirrored or flipped",
                       "set its flip_normals (0.6: flipNormals), or remove that, or the mirroring");
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

    /// Whether neither the camera nor another shape is in a shape's box.
    bool is_alone_inside(const Shape& shape) const {
        const Box3 box = own_box(shape);
        return !box.intersects(scene_.camera.origin) &&
               std::none_of(scene_.shapes.begin(), scene_.shapes.end(), [&](const Shape& other) {
                   const Box3 inner = own_box(other);
                   return &other != &shape && !inner.isEmpty() && box.intersects(inner.min) &&
                          box.intersects(inner.max);
               });
    }

    const Scene& scene_;
    std::vector<Finding>& findings_;
    const FirstHitSearch search_;
    const Box3 box_;
};

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
