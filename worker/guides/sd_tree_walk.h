// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "worker/guides/list_walk.h"

namespace treefarm {

/// Technique that samples the view of a vertex, T2 (docs/design/guiding.md, "views"), where the surface depends on the
/// outgoing direction and a view exists.
struct ViewTechnique {
    using Local = LocalDistribution<ViewTechnique>;
    static constexpr bool kOnSquare = true;
    static_assert(SdTreeSampler::kNoView == kNoDistribution);

    template <class Surface>
    static void find(const SdTreeSampler& guide, const Surface& surface, const Vec3&, const Vec3& outgoing,
                     std::uint32_t region, std::uint32_t& code, Local& view) {
        view.distribution = kNoDistribution;
        if constexpr (Surface::kGeneral) {
            if (!surface.view_dependent()) return;
            code = direction_to_code(outgoing);
            view.distribution = guide.view(region, code);
        }
    }
    static float fraction(const SdTreeSampler& guide, const Local& view) {
        return guide.view_fraction(view.distribution);
    }
    static float least_bsdf_fraction(const SdTreeSampler& guide, const Local& view) {
        return guide.bsdf_fraction(view.distribution);
    }

    static SdTreeSampler::SquareSample sample(const SdTreeSampler& guide, const Local& view, const Draw& random) {
        return guide.sample_square(view.distribution, random[1], random[2], random[3]);
    }
    static float pdf(const SdTreeSampler& guide, const Local& view, std::uint32_t code) {
        return guide.pdf(view.distribution, code);
    }
    /// View of the same direction in another region, if there is one.
    static std::uint32_t moved(const SdTreeSampler& guide, std::uint32_t region, std::uint32_t code,
                               std::uint32_t distribution) {
        const std::uint32_t view = guide.view(region, code);
        return view != kNoDistribution ? view : distribution;
    }

    static void prefetch(const SdTreeSampler& guide, const Local& view, std::uint32_t pick) {
        guide.prefetch(view.distribution, pick);
    }
    static void prefetch_more(const SdTreeSampler& guide, const Local& view, std::uint32_t pick) {
        guide.prefetch_cell(view.distribution, pick);
    }
    static void prefetch_pdf(const SdTreeSampler& guide, const Local& view, std::uint32_t code) {
        guide.prefetch_pdf(view.distribution, code);
    }
    static void prefetch_pdf_more(const SdTreeSampler& guide, const Local& view, std::uint32_t code) {
        guide.prefetch_pdf_cell(view.distribution, code);
    }
};

template <bool kViews>
using SdTreeTechniques =
    std::conditional_t<kViews, TechniqueList<SdTreeSampler, ViewTechnique>, TechniqueList<SdTreeSampler>>;

/// Path-walk adapter of the SD-tree, with or without views.
template <bool kViews>
struct SdTreeWalk : ListWalk<SdTreeTechniques<kViews>> {
    static void prefetch(const SdTreeSampler& guide, std::uint32_t region, std::uint32_t pick) {
        guide.prefetch(region, pick);
        if constexpr (kViews) guide.prefetch_views(region);
    }
    static void prefetch_more(const SdTreeSampler& guide, std::uint32_t region, std::uint32_t pick) {
        guide.prefetch_cell(region, pick);
    }

    /// Radiance by the region's own distribution, with or without a view.
    template <class At, class Drawn>
    static float radiance(const SdTreeSampler& guide, const At& guidance, const Drawn& s) {
        const float flux = guide.flux(guidance.region);
        return flux > 0.0f ? flux * s.guide_pdf : -1.0f;
    }

    /// Adds the records of a vertex. With `ViewRecords` as published only the view learns, and it learns the radiance;
    /// otherwise the region learns the radiance as without views, and the view the reflected radiance.
    template <class Target, class Taught>
    [[gnu::always_inline]] static Record* teach(const RecordRules& rules, std::uint32_t rounding, const Target& target,
                                                const Taught& l, RecordLog& log, Record* end) {
        const bool smooth = l.pdf > 0.0f;
        const float value = smooth ? rules.target_value(l.radiance, l.pdf) : 0.0f;
        const auto of_region = [&](Record* at) {
            return SdTreeWalk::record(target.region, rounding, value, l, l.bins[0], log, at);
        };
        if constexpr (kViews)
            if (const std::uint32_t view = target.further[0]; view != kNoDistribution) {
                const bool product = rules.view_records == ViewRecords::product;
                if (product) end = of_region(end);
                const float of_view = product && smooth ? rules.target_value(l.reflected * l.pdf, l.pdf) : value;
                return SdTreeWalk::record(view, scrambled(rounding, kOfView), of_view, l, l.bins[1], log, end);
            }
        return of_region(end);
    }

  private:
    static constexpr std::uint32_t kOfView = 9;  ///< salt: a view's record is rounded independently of its region's
};

}  // namespace treefarm
