// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "common/math/warp_batch.h"
#include "worker/guides/technique_list.h"

namespace treefarm {

/// Batch of directions to convert to codes together, by vector code. Guidance must stay where it is.
template <class List>
class CodeBatch {
  public:
    using Sampler = typename List::Sampler;
    using Guidance = typename List::Guidance;

    void clear() { count_ = 0; }

    /// Adds a direction and returns its index.
    std::uint32_t add(const Vec3& direction, const Guidance& guidance) {
        directions_.set(count_, direction);
        regions_[count_] = guidance.region;
        if constexpr (kFurther) guidances_[count_] = &guidance;
        return count_++;
    }

    void convert() { direction_to_code_batch(directions_, count_, codes_); }

    /// Prefetches the first data that the guide's densities of these directions read.
    void prefetch(const Sampler& guide) const {
        for (std::uint32_t i = 0; i < count_; ++i) {
            guide.prefetch_pdf(regions_[i], codes_[i]);
            further(i, [&]<class T>(const auto& here) { T::prefetch_pdf(guide, here, codes_[i]); });
        }
    }

    /// Prefetches the next data, addressed by what prefetch() has fetched.
    void prefetch_more(const Sampler& guide) const {
        for (std::uint32_t i = 0; i < count_; ++i) {
            guide.prefetch_pdf_cell(regions_[i], codes_[i]);
            further(i, [&]<class T>(const auto& here) { T::prefetch_pdf_more(guide, here, codes_[i]); });
        }
    }

    std::uint32_t code(std::size_t i) const { return codes_[i]; }
    typename List::Direction operator[](std::size_t i) const {
        if constexpr (List::kOnSquare)
            return codes_[i];
        else
            return {codes_[i], directions_[i]};
    }

  private:
    static constexpr bool kFurther = List::kFurther != 0;

    template <class Visit>
    void further(std::uint32_t i, Visit visit) const {
        List::each([&]<std::size_t k, class T>() {
            const typename T::Local& here = *guidances_[i];
            if (here.here()) visit.template operator()<T>(here);
        });
    }

    std::uint32_t count_ = 0;
    VectorBatch directions_;
    std::array<std::uint32_t, kDrawBatch> regions_;
    std::array<const Guidance*, kFurther ? kDrawBatch : 0> guidances_;
    alignas(64) std::array<std::uint32_t, kDrawBatch> codes_;
};

/// Sampled directions of a batch of paths at their surfaces, from the mixture of a list of techniques: draw() for each
/// path, then convert(), then complete() for each; guidance and samples must stay where they are. draw() and complete()
/// agree by construction: the density of a drawn direction is that of the very cell it was drawn from. `kCoded`: codes
/// are computed also without guiding. A surface has bsdf(), frame() and wo().
template <class List, bool kGuided, bool kCoded>
class TechniqueBatch {
  public:
    using Sampler = typename List::Sampler;
    using Guidance = typename List::Guidance;
    using Scatter = typename List::Scatter;

    void clear() {
        codes_.clear();
        square_count_ = 0;
    }

    /// `technique`, uniform in [0, 1), chooses BSDF or guide; random[1] chooses the BSDF's lobe or the guide's cell,
    /// [2] and [3] the point; `cosine` is that point warped to the cosine hemisphere. False if there is no direction.
    template <class Surface>
    bool draw(const Surface& surface, const Sampler& guide, const Guidance& guidance, float technique,
              const Draw& random, const Vec3& cosine, Scatter& s) {
        s.guided = kGuided && !(technique < guidance.bsdf_fraction);
        s.guide_pdf = 0.0f;
        if constexpr (kFurther) {
            s.technique = 0;
            s.further_pdf.fill(0.0f);
        }
        if (kGuided && s.guided) {
            s.delta = false;
            if constexpr (kFurther) s.technique = List::choose(guidance, technique);
            if (!kFurther || s.technique == 0) {
                const auto drawn = guide.sample_square(guidance.region, random[1], random[2], random[3]);
                s.guide_pdf = drawn.pdf;
                return add(drawn, guidance, s);
            }
            bool drawn = false;
            List::each([&]<std::size_t k, class T>() {
                if (s.technique != k + 1) return;
                const auto sample = T::sample(guide, List::template local<T>(guidance), random);
                s.further_pdf[k] = sample.pdf;
                drawn = add(sample, guidance, s);
            });
            return drawn;
        }
        if (!draw_from_bsdf(surface, random, cosine, s)) return false;
        if (kCoded && !s.delta) s.conversion = codes_.add(s.world, guidance);
        return true;
    }

    /// Converts directions to codes, and points to directions.
    void convert(const Sampler& guide) {
        if constexpr (kCoded) codes_.convert();
        if constexpr (kGuided) {
            codes_.prefetch(guide);
            each_other([&](std::uint32_t region, std::uint32_t code) { guide.prefetch_pdf(region, code); },
                       [&]<class T>(const auto& here, std::uint32_t code) { T::prefetch_pdf(guide, here, code); });
            square_to_direction_batch(square_x_, square_y_, square_count_, directions_);
            codes_.prefetch_more(guide);
            each_other([&](std::uint32_t region, std::uint32_t code) { guide.prefetch_pdf_cell(region, code); },
                       [&]<class T>(const auto& here, std::uint32_t code) { T::prefetch_pdf_more(guide, here, code); });
        }
    }

    /// Evaluates value and density of the drawn direction; pdf or f_cos may be 0.
    template <class Surface>
    void complete(const Surface& surface, const Sampler& guide, const Guidance& guidance, Scatter& s) const {
        if (kGuided && s.guided) {
            set_direction(s);
            s.local = surface.frame().to_local(s.world);
            const BsdfValue b = surface.bsdf().value(surface.wo(), s.local);
            s.f_cos = b.f_cos;
            s.bsdf_pdf = b.pdf;
            if (kFurther && s.technique != 0) s.guide_pdf = guide.pdf(guidance.region, s.code);
        } else if (kCoded && !s.delta) {
            s.code = codes_.code(s.conversion);
            if constexpr (kGuided) s.guide_pdf = guide.pdf(guidance.region, s.code);
        }
        s.pdf = s.bsdf_pdf;
        if constexpr (kGuided) {
            if (s.delta) {
                s.pdf = s.bsdf_pdf * guidance.bsdf_fraction;
            } else {
                List::each([&]<std::size_t k, class T>() {
                    if (List::template local<T>(guidance).here() && !(s.guided && s.technique == k + 1))
                        s.further_pdf[k] = List::template pdf<T>(guide, guidance, s.code, s.world);
                });
                s.pdf = List::mixed_pdf(guidance, s.bsdf_pdf, s.guide_pdf, s.further_pdf);
            }
        }
        s.effective_pdf = s.pdf;
    }

  private:
    static constexpr bool kFurther = List::kFurther != 0;

    /// Adds what a technique has drawn: a point of the direction square with its code, or a direction.
    template <class Sample>
    bool add(const Sample& drawn, const Guidance& guidance, Scatter& s) {
        if constexpr (requires { drawn.at; }) {
            s.code = drawn.code;
            s.conversion = square_count_;
            square_x_[square_count_] = drawn.at.x;
            square_y_[square_count_] = drawn.at.y;
            if constexpr (kFurther) points_[square_count_] = {&guidance, &s};
            ++square_count_;
            return true;
        } else {
            s.world = drawn.direction;
            s.conversion = codes_.add(s.world, guidance);
            return drawn.pdf > 0.0f;
        }
    }

    /// Sets direction and code of a sample of the guide; one of both is known.
    void set_direction(Scatter& s) const {
        if constexpr (List::kOnSquare) {
            s.world = directions_[s.conversion];
        } else {
            bool on_square = true;
            List::each([&]<std::size_t k, class T>() { on_square &= T::kOnSquare || s.technique != k + 1; });
            if (on_square)
                s.world = directions_[s.conversion];
            else
                s.code = codes_.code(s.conversion);
        }
    }

    /// Calls region(region, code) or further<T>(local, code) for each technique that the points were not drawn from.
    template <class OfRegion, class OfFurther>
    void each_other(OfRegion region, OfFurther further) const {
        if constexpr (kFurther)
            for (std::uint32_t i = 0; i < square_count_; ++i) {
                const auto& [guidance, s] = points_[i];
                if (s->technique != 0) region(guidance->region, s->code);
                List::each([&, at = guidance, drawn = s]<std::size_t k, class T>() {
                    const typename T::Local& here = *at;
                    if (here.here() && drawn->technique != k + 1) further.template operator()<T>(here, drawn->code);
                });
            }
    }

    struct Point {
        const Guidance* guidance;
        const Scatter* sample;
    };

    CodeBatch<List> codes_;
    std::uint32_t square_count_ = 0;
    std::array<Point, kFurther ? kDrawBatch : 0> points_;
    alignas(64) std::array<float, kDrawBatch> square_x_, square_y_;
    VectorBatch directions_;
};

}  // namespace treefarm
