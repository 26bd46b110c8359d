// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "common/guiding/regions/mixture.h"
#include "common/guiding/sd_tree/sd_tree_sampler.h"
#include "common/math/warp_batch.h"
#include "worker/integrators/path/scatter_sample.h"
#include "worker/integrators/record_log.h"

namespace treefarm {

/// Guidance of the SD-tree at a point.
struct SdTreeGuidance {
    std::uint32_t region;  ///< of the tree
    std::uint32_t view;    ///< distribution of the view at the point, or SdTreeSampler::kNoView
    float bsdf_fraction;   ///< probability of sampling the BSDF
    float view_fraction;   ///< probability of sampling the view; the rest is that of the region's own distribution

    bool has_view() const { return view != SdTreeSampler::kNoView; }
    void sample_bsdf_alone() {
        bsdf_fraction = 1.0f;
        view_fraction = 0.0f;
    }
};

/// A sampled direction with its code and densities in the tree.
struct SdTreeScatter : ScatterSample {
    float view_pdf;            ///< of the view's distribution alone, if it guides
    std::uint32_t code;        ///< Z-order code of the direction, if the tree is used
    std::uint32_t conversion;  ///< index in the batch's conversions
    bool by_view;              ///< drawn from the view
};

/// Density of the mixture of BSDF, region's distribution and view's distribution, each with its probability.
inline float mixed_pdf(const SdTreeGuidance& guidance, float bsdf_pdf, float guide_pdf, float view_pdf) {
    const float trees = (1.0f - guidance.bsdf_fraction - guidance.view_fraction) * guide_pdf;
    return guidance.bsdf_fraction * bsdf_pdf + (trees + guidance.view_fraction * view_pdf);
}

/// Density that the mixture of BSDF and region would have without the view.
inline float without_view(const SdTreeGuidance& guidance, float bsdf_pdf, float guide_pdf) {
    const float others = 1.0f - guidance.view_fraction;
    return (guidance.bsdf_fraction * bsdf_pdf + (others - guidance.bsdf_fraction) * guide_pdf) / others;
}

/// Density of the mixture at a direction that was not drawn from it.
template <bool kViews>
float mixed_pdf_at(const SdTreeSampler& guide, const SdTreeGuidance& guidance, float bsdf_pdf, std::uint32_t code) {
    const float guide_pdf = guide.pdf(guidance.region, code);
    if (kViews && guidance.has_view()) return mixed_pdf(guidance, bsdf_pdf, guide_pdf, guide.pdf(guidance.view, code));
    return mixed_pdf(guidance.bsdf_fraction, bsdf_pdf, guide_pdf);
}

/// Adds the view of the outgoing direction to the region's guidance, if the surface is view-dependent and a view
/// exists. Without kGuided the fractions do not change. `outgoing_code` is set if the surface is view-dependent.
template <bool kGuided>
void find_view(const SdTreeSampler& guide, bool view_dependent, const Vec3& outgoing, std::uint32_t& outgoing_code,
               SdTreeGuidance& guidance) {
    guidance.view = SdTreeSampler::kNoView;
    guidance.view_fraction = 0.0f;
    if (!view_dependent) return;
    outgoing_code = direction_to_code(outgoing);
    guidance.view = guide.view(guidance.region, outgoing_code);
    if (!kGuided || !guidance.has_view()) return;
    // The view takes its fraction from region and BSDF alike, but the BSDF keeps at least the fraction that the view
    // learned.
    const float of_view = guide.view_fraction(guidance.view);
    guidance.bsdf_fraction = std::max(guide.bsdf_fraction(guidance.view), guidance.bsdf_fraction * (1.0f - of_view));
    guidance.view_fraction = std::min(of_view, 1.0f - guidance.bsdf_fraction);
}

/// Batch of directions to convert to codes together, by vector code.
template <bool kViews>
class SdTreeCodeBatch {
  public:
    void clear() { count_ = 0; }

    /// Adds a direction and returns its index.
    std::uint32_t add(const Vec3& direction, const SdTreeGuidance& guidance) {
        directions_.set(count_, direction);
        regions_[count_] = guidance.region;
        if constexpr (kViews) views_[count_] = guidance.view;
        return count_++;
    }

    void convert() { direction_to_code_batch(directions_, count_, codes_); }

    /// Prefetches the first data that the tree's densities of these directions read.
    void prefetch(const SdTreeSampler& guide) const {
        for (std::uint32_t i = 0; i < count_; ++i) {
            guide.prefetch_pdf(regions_[i], codes_[i]);
            if (kViews && views_[i] != SdTreeSampler::kNoView) guide.prefetch_pdf(views_[i], codes_[i]);
        }
    }

    /// Prefetches the next data, addressed by what prefetch() has fetched.
    void prefetch_more(const SdTreeSampler& guide) const {
        for (std::uint32_t i = 0; i < count_; ++i) {
            guide.prefetch_pdf_cell(regions_[i], codes_[i]);
            if (kViews && views_[i] != SdTreeSampler::kNoView) guide.prefetch_pdf_cell(views_[i], codes_[i]);
        }
    }

    std::uint32_t operator[](std::size_t i) const { return codes_[i]; }

  private:
    std::uint32_t count_ = 0;
    VectorBatch directions_;
    std::array<std::uint32_t, kDrawBatch> regions_;
    std::array<std::uint32_t, kViews ? kDrawBatch : 0> views_;
    alignas(64) std::array<std::uint32_t, kDrawBatch> codes_;
};

/// Sampled directions of a batch of paths at their surfaces, from the BSDF's density or from bsdf_fraction * p_BSDF +
/// (1 - bsdf_fraction) * p_guide: draw() for each path, then convert(), then complete() for each. draw() and complete()
/// agree by construction: the guide's density of a guided sample is that of the very cell it was drawn from. `kCoded`:
/// codes are computed also without guiding; `kViews`: views are allowed. A surface has bsdf(), frame() and wo().
template <bool kGuided, bool kCoded, bool kViews = false>
class SdTreeScatterBatch {
  public:
    void clear() {
        codes_.clear();
        square_count_ = 0;
    }

    /// `technique`, uniform in [0, 1), chooses BSDF or guide; random[1] chooses the BSDF's lobe or the guide's cell,
    /// [2] and [3] the point; `cosine` is that point warped to the cosine hemisphere. False if there is no direction.
    template <class Surface>
    bool draw(const Surface& surface, const SdTreeSampler& guide, const SdTreeGuidance& guidance, float technique,
              const Draw& random, const Vec3& cosine, SdTreeScatter& s) {
        s.guided = kGuided && !(technique < guidance.bsdf_fraction);
        s.by_view = false;
        s.guide_pdf = s.view_pdf = 0.0f;
        if (kGuided && s.guided) {
            s.by_view = kViews && technique < guidance.bsdf_fraction + guidance.view_fraction;
            const SdTreeSampler::SquareSample drawn = guide.sample_square(
                kViews && s.by_view ? guidance.view : guidance.region, random[1], random[2], random[3]);
            s.code = drawn.code;
            (kViews && s.by_view ? s.view_pdf : s.guide_pdf) = drawn.pdf;
            s.delta = false;
            s.conversion = square_count_;
            square_x_[square_count_] = drawn.at.x;
            square_y_[square_count_] = drawn.at.y;
            if constexpr (kViews) others_[square_count_] = {s.by_view ? guidance.region : guidance.view, drawn.code};
            ++square_count_;
            return true;
        }
        if (!draw_from_bsdf(surface, random, cosine, s)) return false;
        if (kCoded && !s.delta) s.conversion = codes_.add(s.world, guidance);
        return true;
    }

    /// Converts the BSDFs' directions to codes, and the guide's points to directions.
    void convert(const SdTreeSampler& guide) {
        if constexpr (kCoded) codes_.convert();
        if constexpr (kGuided) {
            codes_.prefetch(guide);
            each_other([&](std::uint32_t other, std::uint32_t code) { guide.prefetch_pdf(other, code); });
            square_to_direction_batch(square_x_, square_y_, square_count_, directions_);
            codes_.prefetch_more(guide);
            each_other([&](std::uint32_t other, std::uint32_t code) { guide.prefetch_pdf_cell(other, code); });
        }
    }

    /// Evaluates value and density of the drawn direction; pdf or f_cos may be 0.
    template <class Surface>
    void complete(const Surface& surface, const SdTreeSampler& guide, const SdTreeGuidance& guidance,
                  SdTreeScatter& s) const {
        if (kGuided && s.guided) {
            s.world = directions_[s.conversion];
            s.local = surface.frame().to_local(s.world);
            const BsdfValue b = surface.bsdf().value(surface.wo(), s.local);
            s.f_cos = b.f_cos;
            s.bsdf_pdf = b.pdf;
            if (kViews && s.by_view) s.guide_pdf = guide.pdf(guidance.region, s.code);
        } else if (kCoded && !s.delta) {
            s.code = codes_[s.conversion];
            if constexpr (kGuided) s.guide_pdf = guide.pdf(guidance.region, s.code);
        }
        s.pdf = s.bsdf_pdf;
        if constexpr (kGuided) {
            if (s.delta)
                s.pdf = s.bsdf_pdf * guidance.bsdf_fraction;
            else if (kViews && guidance.has_view())
                s.pdf = viewed_pdf(guide, guidance, s);
            else
                s.pdf = mixed_pdf(guidance.bsdf_fraction, s.bsdf_pdf, s.guide_pdf);
        }
        s.effective_pdf = s.pdf;
    }

  private:
    static float viewed_pdf(const SdTreeSampler& guide, const SdTreeGuidance& guidance, SdTreeScatter& s) {
        if (!s.guided || !s.by_view) s.view_pdf = guide.pdf(guidance.view, s.code);
        return mixed_pdf(guidance, s.bsdf_pdf, s.guide_pdf, s.view_pdf);
    }

    /// Calls visit(distribution, code) for each guiding distribution that the guided points were not drawn from.
    template <class Visit>
    void each_other(Visit visit) const {
        if constexpr (kViews)
            for (std::uint32_t i = 0; i < square_count_; ++i)
                if (others_[i].distribution != SdTreeSampler::kNoView) visit(others_[i].distribution, others_[i].code);
    }

    struct Other {
        std::uint32_t distribution, code;
    };

    SdTreeCodeBatch<kViews> codes_;
    std::uint32_t square_count_ = 0;
    std::array<Other, kViews ? kDrawBatch : 0> others_;
    alignas(64) std::array<float, kDrawBatch> square_x_, square_y_;
    VectorBatch directions_;
};

/// Distributions that learn from a vertex.
struct SdTreeTarget {
    std::uint32_t region = SdTreeSampler::kNoView;  ///< kNoView: nothing learns
    std::uint32_t view = SdTreeSampler::kNoView;    ///< distribution of the view, if there is one

    bool empty() const { return region == SdTreeSampler::kNoView; }
    bool has_view() const { return view != SdTreeSampler::kNoView; }
};

/// Bins of a direction in the histograms that mixtures learn from (mixture.h, view_mixture.h).
struct SdTreeBins {
    std::uint8_t region = 0, view = 0;
};

/// Path-walk adapter of the SD-tree (worker/integrators/path/guide_walk.h), with or without views.
template <bool kViews>
struct SdTreeWalk {
    using Sampler = SdTreeSampler;
    using Guidance = SdTreeGuidance;
    using Scatter = SdTreeScatter;
    using Direction = std::uint32_t;
    using Target = SdTreeTarget;
    using Bins = SdTreeBins;
    /// Z-order code of the outgoing direction, set if the surface is view-dependent.
    using Outgoing = std::uint32_t;
    template <bool kGuided, bool kConverts>
    using ScatterBatch = SdTreeScatterBatch<kGuided, kConverts, kViews>;
    using LightBatch = SdTreeCodeBatch<kViews>;

    static constexpr bool kLocal = kViews;
    static constexpr std::uint32_t kRecordsPerVertex = 2;
    static constexpr Bins kDeltaBins = {kMixtureBins - 1, kMixtureBins - 1};

    static Guidance unguided() { return {0, SdTreeSampler::kNoView, 1.0f, 0.0f}; }

    template <bool kGuided, class Surface>
    static void localise(const Sampler& guide, const Surface& surface, const Vec3& outgoing, Outgoing& code,
                         Guidance& guidance) {
        if constexpr (Surface::kGeneral) find_view<kGuided>(guide, surface.view_dependent(), outgoing, code, guidance);
    }

    // Sampling's data is prefetched in steps, each addressed by the one before.
    static void prefetch(const Sampler& guide, std::uint32_t region, std::uint32_t pick) {
        guide.prefetch(region, pick);
        if constexpr (kViews) guide.prefetch_views(region);
    }
    static void prefetch_more(const Sampler& guide, std::uint32_t region, std::uint32_t pick) {
        guide.prefetch_cell(region, pick);
    }
    static void prefetch_local(const Sampler& guide, const Guidance& guidance, std::uint32_t pick) {
        if (guidance.has_view()) guide.prefetch(guidance.view, pick);
    }
    static void prefetch_local_more(const Sampler& guide, const Guidance& guidance, std::uint32_t pick) {
        if (guidance.has_view()) guide.prefetch_cell(guidance.view, pick);
    }

    static float pdf(const Sampler& guide, const Guidance& guidance, float bsdf_pdf, Direction code) {
        return mixed_pdf_at<kViews>(guide, guidance, bsdf_pdf, code);
    }

    static Target target(const Guidance& guidance) { return {guidance.region, guidance.view}; }

    /// Target moved to another `region`; its view becomes that region's view of the same direction, if there is one.
    static Target moved(const Sampler& guide, std::uint32_t region, Outgoing outgoing_code, Target target) {
        target.region = region;
        if (kViews && target.has_view()) {
            const std::uint32_t view = guide.view(target.region, outgoing_code);
            if (view != SdTreeSampler::kNoView) target.view = view;
        }
        return target;
    }

    static Direction direction(const Scatter& s) { return s.code; }
    /// Direction of a point of the direction square.
    static Direction direction_at(const Vec2& square) { return square_to_code(square); }

    static Bins bins(const Guidance& guidance, const Scatter& s) {
        Bins bins{mixture_bin(s.bsdf_pdf, s.guide_pdf)};
        if (kViews && guidance.has_view())
            bins.view = mixture_bin(without_view(guidance, s.bsdf_pdf, s.guide_pdf), s.view_pdf);
        return bins;
    }

    /// Radiance by the region's own distribution, with or without a view.
    static float radiance(const Sampler& guide, const Guidance& guidance, const Scatter& s) {
        const float flux = guide.flux(guidance.region);
        return flux > 0.0f ? flux * s.guide_pdf : -1.0f;
    }

    /// Adds the records of a vertex. With `ViewRecords` as published only the view learns, and it learns the radiance;
    /// otherwise the region learns the radiance as without views, and the view the reflected radiance.
    template <class Taught>
    [[gnu::always_inline]] static Record* teach(const RecordRules& rules, std::uint32_t rounding, const Target& target,
                                                const Taught& l, RecordLog& log, Record* end) {
        const bool smooth = l.pdf > 0.0f;
        const float value = smooth ? rules.target_value(l.radiance, l.pdf) : 0.0f;
        const float mixture = l.of_mixture ? l.reflected : 0.0f;
        if (!target.has_view()) {
            log.counts[target.region] += smooth;
            return append_record({target.region, l.direction, rounding, value, mixture, l.bins.region}, end);
        }
        const bool product = rules.view_records == ViewRecords::product;
        if (product) {
            log.counts[target.region] += smooth;
            end = append_record({target.region, l.direction, rounding, value, mixture, l.bins.region}, end);
        }
        log.counts[target.view] += smooth;
        const float of_view = product && smooth ? rules.target_value(l.reflected * l.pdf, l.pdf) : value;
        return append_record({target.view, l.direction, scrambled(rounding, kOfView), of_view, mixture, l.bins.view},
                             end);
    }

  private:
    static constexpr std::uint32_t kOfView = 9;  ///< salt: a view's record is rounded independently of its region's
};

}  // namespace treefarm
