// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstdint>

#include "common/guiding/regions/region_sampler.h"
#include "common/guiding/statistics/cell_sums.h"
#include "worker/integrators/path/scatter_sample.h"
#include "worker/integrators/record_log.h"

namespace treefarm {

/// Adapter by which the path walk uses a guide, inlined, for a batch of paths. Learned data and look-ups belong to the
/// guide (worker/guides); regions and their common data belong to the walk. worker/guides/list_walk.h derives most of
/// the adapter from a list of techniques.
///
/// In the walk's order: a path's region is found, and prefetch() called; localise(), for guides that depend on more
/// than the region, once the surface is known; LightBatch holds next event's directions, for pdf(); ScatterBatch draws
/// the path's own direction; target(), moved(), direction() and bins() describe what a vertex teaches, radiance() is
/// the guide's present estimate for the direction, and teach() writes the records. A walk may also have
/// teach_path(log, key, radiance), for records of whole paths: each path, or copy of one, and what it carried.
template <class G>
concept GuideWalk = std::derived_from<typename G::Sampler, RegionSampler> &&
    requires(const typename G::Sampler& guide, typename G::Guidance guidance, typename G::Scatter scatter,
             typename G::Direction direction, typename G::Target target, typename G::Outgoing outgoing,
             typename G::LightBatch lights, const RecordRules& rules) {
    /// Guidance at a point: its region, and the probability of sampling the BSDF.
    { guidance.region } -> std::convertible_to<std::uint32_t>;
    { guidance.bsdf_fraction } -> std::convertible_to<float>;
    guidance.sample_bsdf_alone();
    { G::unguided() } -> std::same_as<typename G::Guidance>;
    requires std::derived_from<typename G::Scatter, ScatterSample>;
    /// Whether guidance depends on more than the region.
    { G::kLocal } -> std::convertible_to<bool>;
    { G::pdf(guide, guidance, 1.0f, direction) } -> std::same_as<float>;
    { G::target(guidance) } -> std::same_as<typename G::Target>;
    { G::moved(guide, 0u, outgoing, target) } -> std::same_as<typename G::Target>;
    { target.empty() } -> std::same_as<bool>;
    { G::direction(scatter) } -> std::same_as<typename G::Direction>;
    { G::bins(guidance, scatter) } -> std::same_as<typename G::Bins>;
    { G::radiance(guide, guidance, scatter) } -> std::same_as<float>;
    { G::kDeltaBins } -> std::convertible_to<typename G::Bins>;
    { G::kRecordsPerVertex } -> std::convertible_to<std::uint32_t>;
    lights.clear();
    lights.convert();
};

/// Log of the records of a walk: the walk's own type, or that of guides with cells.
template <class G>
struct LogOfWalk {
    using type = RecordLog;
};
template <class G>
requires requires {
    typename G::Log;
}
struct LogOfWalk<G> {
    using type = typename G::Log;
};
template <class G>
using LogOf = typename LogOfWalk<G>::type;

/// Adapter for unguided paths that record nothing.
struct NoGuide {
    using Sampler = RegionSampler;
    struct Guidance {
        std::uint32_t region;
        float bsdf_fraction;
        void sample_bsdf_alone() {}
    };
    using Scatter = ScatterSample;
    struct Nothing {
        static bool empty() { return true; }
    };
    using Direction = Nothing;
    using Target = Nothing;
    using Bins = Nothing;
    using Outgoing = Nothing;

    template <bool kGuided, bool kConverts>
    struct ScatterBatch {
        static_assert(!kGuided && !kConverts);
        void clear() {}
        template <class Surface>
        bool draw(const Surface& surface, const Sampler&, const Guidance&, float, const Draw& random,
                  const Vec3& cosine, Scatter& s) {
            s.guided = false;
            s.guide_pdf = 0.0f;
            return draw_from_bsdf(surface, random, cosine, s);
        }
        void convert(const Sampler&) {}
        template <class Surface>
        void complete(const Surface&, const Sampler&, const Guidance&, Scatter& s) const {
            s.effective_pdf = s.pdf = s.bsdf_pdf;
        }
    };
    struct LightBatch {
        void clear() {}
        void convert() {}
        Nothing operator[](std::size_t) const { return {}; }
    };

    static constexpr bool kLocal = false;
    static constexpr std::uint32_t kRecordsPerVertex = 0;
    static constexpr Bins kDeltaBins = {};
    static Guidance unguided() { return {0, 1.0f}; }
    static float pdf(const Sampler&, const Guidance&, float bsdf_pdf, Direction) { return bsdf_pdf; }
    static Target target(const Guidance&) { return {}; }
    static Target moved(const Sampler&, std::uint32_t, Outgoing, Target target) { return target; }
    static Direction direction(const Scatter&) { return {}; }
    static Bins bins(const Guidance&, const Scatter&) { return {}; }
    static float radiance(const Sampler&, const Guidance&, const Scatter&) { return -1.0f; }
};
static_assert(GuideWalk<NoGuide>);

}  // namespace treefarm
