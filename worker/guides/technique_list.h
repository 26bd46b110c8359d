// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "common/guiding/regions/mixture.h"
#include "worker/integrators/path/scatter_sample.h"

namespace treefarm {

inline constexpr std::uint32_t kNoDistribution = 0xffffffffu;

/// Least data of a further technique `T` at a vertex.
template <class T>
struct LocalDistribution {
    std::uint32_t distribution = kNoDistribution;  ///< that it samples and that learns; kNoDistribution: none here
    float fraction = 0.0f;                         ///< probability of sampling it; 0 if there is none

    bool here() const { return distribution != kNoDistribution; }
};

/// A direction with its Z-order code on the direction square.
struct CodedDirection {
    std::uint32_t code;
    Vec3 world;
};
inline std::uint32_t code_of(std::uint32_t code) {
    return code;
}
inline std::uint32_t code_of(const CodedDirection& direction) {
    return direction.code;
}

/// Techniques of a vertex as a compile-time list. Directions are drawn from the mixture
///
///   p = a_B p_B + a_1 p_1 + a_2 p_2 + ...
///
/// of the BSDF and the techniques of a guide with sampler `S`; the fractions sum to one. Technique 1 is the region's
/// own distribution, which S samples; its fraction is the rest. Each of `Further` is a struct such as ViewTechnique:
///
///   Local        data of a vertex, kept between draw and density: a LocalDistribution, or derived from one
///   kOnSquare    whether it draws points of the direction square (direction_map.h), as S does, or directions
///   find(guide, surface, position, outgoing, region, code, local)   looks up Local::distribution at a vertex; `code`
///                                                                   receives the outgoing direction's if it is needed
///   fraction(guide, local), least_bsdf_fraction(guide, local)       learned; the techniques before it share the rest
///   sample(guide, local, random)     point or direction by random[1] to [3], with its density, 0 if there is none
///   pdf(guide, local, direction)     the same density per steradian; `direction`: its code if kOnSquare, else a vector
///   moved(guide, region, code, distribution)                        distribution in another region, for records
///   prefetch(), prefetch_more(), prefetch_pdf(), prefetch_pdf_more()   data of sample() and pdf(), in two steps
///
/// Fractions are learned one by one, each from the histogram of its distribution (mixture.h), in which the mixture of
/// the techniques before it stands for the BSDF. So a further technique changes nothing of what those before it learn.
template <class S, class... Further>
struct TechniqueList {
    using Sampler = S;
    static constexpr std::size_t kFurther = sizeof...(Further);
    static constexpr bool kOnSquare = (... && Further::kOnSquare);

    /// List with one more technique; `T`: its sampler, derived from S.
    template <class T, class Technique>
    using With = TechniqueList<T, Further..., Technique>;

    struct Nothing {};
    /// Lists without further techniques have the layout of those with one: a PathState of 512 or 520 bytes takes more
    /// instructions to address.
    using Spare = std::conditional_t<kFurther == 0, std::uint64_t, Nothing>;
    struct Region {
        std::uint32_t region;
        float bsdf_fraction;  ///< probability of sampling the BSDF
        [[no_unique_address]] Spare spare{};
    };
    /// Guidance at a vertex.
    struct Guidance : Region, Further::Local... {
        void sample_bsdf_alone() {
            Region::bsdf_fraction = 1.0f;
            ((static_cast<typename Further::Local&>(*this).fraction = 0.0f), ...);
        }
    };
    using FurtherPdfs = std::array<float, std::max<std::size_t>(kFurther, 1)>;
    /// A sampled direction with its densities.
    struct Scatter : ScatterSample {
        FurtherPdfs further_pdf;   ///< of the further techniques, if they guide; 0: none here
        std::uint32_t code;        ///< Z-order code of the direction, if the guide is used
        std::uint32_t conversion;  ///< index in the batch's conversions
        std::uint8_t technique;    ///< if `guided`: index of the further one that drew it, plus 1
    };
    using Direction = std::conditional_t<kOnSquare, std::uint32_t, CodedDirection>;
    /// Bins of a direction in the histograms by which the techniques' fractions are learned.
    using Bins = std::array<std::uint8_t, 1 + kFurther>;

    /// Calls visit.operator()<k, T>() for each further technique T, number k from 0.
    template <class Visit>
    [[gnu::always_inline]] static void each(Visit visit) {
        [&]<std::size_t... k>(std::index_sequence<k...>) {
            (visit.template operator()<k, Further>(), ...);
        }
        (std::index_sequence_for<Further...>());
    }
    template <class T>
    static const typename T::Local& local(const Guidance& guidance) {
        return guidance;
    }

    /// Finds the further techniques at a vertex and sets their fractions if the vertex is guided. Each takes its own
    /// from those before it alike, but the BSDF keeps at least least_bsdf_fraction().
    template <bool kGuided, class Surface>
    static void find(const S& guide, const Surface& surface, const Vec3& position, const Vec3& outgoing,
                     std::uint32_t& code, Guidance& guidance) {
        each([&]<std::size_t k, class T>() {
            typename T::Local& here = guidance;
            T::find(guide, surface, position, outgoing, guidance.region, code, here);
            here.fraction = 0.0f;
            if (!kGuided || !here.here()) return;
            const float fraction = T::fraction(guide, here);
            guidance.bsdf_fraction =
                std::max(T::least_bsdf_fraction(guide, here), guidance.bsdf_fraction * (1.0f - fraction));
            float rest = 1.0f - guidance.bsdf_fraction;
            each([&]<std::size_t before, class Before>() {
                if constexpr (before < k) {
                    typename Before::Local& other = guidance;
                    rest -= other.fraction *= 1.0f - fraction;
                }
            });
            here.fraction = std::min(fraction, rest);
        });
    }

    /// Further technique, plus 1, that `technique`, uniform in [bsdf_fraction, 1), chooses; 0: the region's own.
    static std::uint8_t choose(const Guidance& guidance, float technique) {
        std::uint8_t chosen = 0;
        float end = guidance.bsdf_fraction;
        each([&]<std::size_t k, class T>() {
            end += local<T>(guidance).fraction;
            if (chosen == 0 && technique < end) chosen = static_cast<std::uint8_t>(k + 1);
        });
        return chosen;
    }

    /// Density of the mixture.
    static float mixed_pdf(const Guidance& guidance, float bsdf_pdf, float guide_pdf, const FurtherPdfs& further) {
        float rest = 1.0f - guidance.bsdf_fraction;
        each([&]<std::size_t k, class T>() { rest -= local<T>(guidance).fraction; });
        float guides = rest * guide_pdf;
        each([&]<std::size_t k, class T>() { guides += local<T>(guidance).fraction * further[k]; });
        return guidance.bsdf_fraction * bsdf_pdf + guides;
    }

    /// Density of the mixture that the techniques before further number `k` have by themselves.
    template <std::size_t k>
    static float pdf_before(const Guidance& guidance, float bsdf_pdf, float guide_pdf, const FurtherPdfs& further) {
        float all = 1.0f;
        each([&]<std::size_t i, class T>() {
            if constexpr (i >= k) all -= local<T>(guidance).fraction;
        });
        float rest = all - guidance.bsdf_fraction;
        each([&]<std::size_t i, class T>() {
            if constexpr (i < k) rest -= local<T>(guidance).fraction;
        });
        float guides = rest * guide_pdf;
        each([&]<std::size_t i, class T>() {
            if constexpr (i < k) guides += local<T>(guidance).fraction * further[i];
        });
        return (guidance.bsdf_fraction * bsdf_pdf + guides) / all;
    }

    /// Density of a further technique for a direction.
    template <class T>
    static float pdf(const S& guide, const Guidance& guidance, std::uint32_t code, const Vec3& world) {
        if constexpr (T::kOnSquare)
            return T::pdf(guide, local<T>(guidance), code);
        else
            return T::pdf(guide, local<T>(guidance), world);
    }

    static Bins bins(const Guidance& guidance, const Scatter& s) {
        Bins bins{mixture_bin(s.bsdf_pdf, s.guide_pdf)};
        each([&]<std::size_t k, class T>() {
            if (!local<T>(guidance).here()) return;
            const float before = pdf_before<k>(guidance, s.bsdf_pdf, s.guide_pdf, s.further_pdf);
            bins[k + 1] = mixture_bin(before, s.further_pdf[k]);
        });
        return bins;
    }
};

}  // namespace treefarm
