// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "common/base/random.h"
#include "common/math/frame.h"
#include "tests/support/chi_square.h"
#include "tests/support/random_tree.h"
#include "worker/guides/sd_tree_walk.h"
#include "worker/shading/plain_diffuse.h"

namespace treefarm {
namespace {

constexpr double kBsdfSignificance = 1e-4;
constexpr std::uint32_t kBsdfSamples = 500000;

Vec2 uniform_draw(std::uint32_t i) {
    const Draw r = draw({7, i, 0}, 0, Stream::scatter);
    return {to_unit(r[2]), to_unit(r[3])};
}

PlainDiffuse grey(float reflectance, bool twosided) {
    return {Rgb(reflectance), twosided};
}

TEST(BsdfDistribution, SamplesFollowTheDensity) {
    for (const bool twosided : {false, true})
        for (const Vec3& wo : {Vec3(0, 0, 1), normalize(Vec3(1, 0.3f, 0.01f)), normalize(Vec3(-0.2f, 0.5f, -0.6f))}) {
            const PlainDiffuse bsdf = grey(0.5f, twosided);
            const auto sample = [&](std::uint32_t i, Vec3& d) {
                const BsdfSample s = bsdf.sample(wo, {0.0f, uniform_draw(i)});
                d = s.wi;
                return s.pdf > 0.0f;
            };
            const auto result = test::test_directions(
                sample, [&](const Vec3& d) { return bsdf.value(wo, d).pdf; }, kBsdfSamples);
            const bool visible = wo.z > 0.0f || twosided;
            EXPECT_NEAR(result.integral, visible ? 1.0 : 0.0, 1e-3);
            EXPECT_NEAR(result.success, visible ? 1.0 : 0.0, 1e-5);
            EXPECT_GT(result.p_value, kBsdfSignificance);
        }
}

TEST(BsdfDistribution, SamplesAndDensityAreOfTheSameBsdf) {
    const PlainDiffuse bsdf = grey(0.7f, true);
    const Vec3 wo = normalize(Vec3(0.3f, 0.1f, -0.8f));
    for (std::uint32_t i = 0; i < 10000; ++i) {
        const BsdfSample s = bsdf.sample(wo, {0.0f, uniform_draw(i)});
        if (!(s.pdf > 0.0f)) continue;
        ASSERT_EQ(s.pdf, bsdf.value(wo, s.wi).pdf);
        ASSERT_EQ(s.f_cos, bsdf.value(wo, s.wi).f_cos);
    }
}

TEST(BsdfDistribution, ReflectsItsReflectanceAndNoMore) {
    for (const float reflectance : {0.0f, 0.3f, 1.0f}) {
        PlainDiffuse bsdf = grey(reflectance, false);
        double sum = 0;
        constexpr int kSteps = 512;
        for (int y = 0; y < kSteps; ++y)
            for (int x = 0; x < kSteps; ++x) {
                const Vec3 d = square_to_sphere({(float(x) + 0.5f) / kSteps, (float(y) + 0.5f) / kSteps});
                sum += bsdf.value(normalize(Vec3(1, 1, 1)), d).f_cos.x;
            }
        EXPECT_NEAR(sum * 4 * M_PI / (kSteps * kSteps), reflectance, 1e-4);
    }
}

const SdTree& trained_tree() {
    static const SdTree tree = test::random_tree(5, 100000, 2000.0, 3);
    return tree;
}

/// A trained tree; its cells are no finer than the grid on which the tests integrate.
const SdTreeSampler& trained_guide() {
    static const SdTreeSampler guide(trained_tree());
    return guide;
}

TEST(GuideDistribution, SamplesFollowTheDensity) {
    const SdTreeSampler& guide = trained_guide();
    ASSERT_GT(guide.region_count(), 8u);
    for (const std::uint32_t region : {0u, guide.region_count() / 2, guide.region_count() - 1}) {
        const auto sample = [&](std::uint32_t i, Vec3& d) {
            const Draw r = draw({8, i, 0}, 0, Stream::scatter);
            const SdTreeSampler::Sample s = guide.sample(region, r[1], r[2], r[3]);
            d = s.direction;
            return s.pdf > 0.0f;
        };
        const auto density = [&](const Vec3& d) { return guide.pdf(region, direction_to_code(d)); };
        const auto result = test::test_directions(sample, density, kBsdfSamples, 16, 64);
        EXPECT_NEAR(result.integral, 1.0, 1e-3);
        EXPECT_EQ(result.success, 1.0);
        EXPECT_GT(result.p_value, kBsdfSignificance) << "region " << region;
    }
}

using ViewWalk = SdTreeWalk<true>;
using ViewGuidance = ViewWalk::Guidance;
using ViewScatter = ViewWalk::Scatter;

/// A surface that directions are drawn for, without the geometry.
class TestSurface {
  public:
    TestSurface(const PlainDiffuse& bsdf, const Vec3& n, const Vec3& wo)
        : bsdf_(bsdf), frame_(normalize(n)), wo_(normalize(wo)) {}
    const PlainDiffuse& bsdf() const { return bsdf_; }
    const Frame& frame() const { return frame_; }
    const Vec3& wo() const { return wo_; }

  private:
    PlainDiffuse bsdf_;
    Frame frame_;
    Vec3 wo_;
};

/// Directions as a batch of paths draws them at one surface; f_cos black: none.
class MixtureSamples {
  public:
    MixtureSamples(const TestSurface& surface, const SdTreeSampler& guide, std::uint32_t region, float fraction)
        : MixtureSamples(surface, guide, ViewGuidance{{region, fraction}, {}}) {}
    MixtureSamples(const TestSurface& surface, const SdTreeSampler& guide, const ViewGuidance& guidance)
        : surface_(surface), guide_(guide), guidance_(guidance) {}

    /// The sample of a number. Samples of numbers that follow each other come from one batch.
    const ViewScatter& operator[](std::uint32_t i) {
        if (i / kDrawBatch != batch_) fill(i / kDrawBatch);
        return samples_[i % kDrawBatch];
    }

    float pdf(float bsdf_pdf, std::uint32_t code) const {
        const float guide_pdf = guide_.pdf(guidance_.region, code);
        if (!guidance_.here()) return mixed_pdf(guidance_.bsdf_fraction, bsdf_pdf, guide_pdf);
        return ViewWalk::List::mixed_pdf(guidance_, bsdf_pdf, guide_pdf, {guide_.pdf(guidance_.distribution, code)});
    }

  private:
    void fill(std::uint32_t batch) {
        batch_ = batch;
        KeyBatch keys;
        for (std::uint32_t k = 0; k < kDrawBatch; ++k) {
            keys.pixel[k] = batch * kDrawBatch + k;
            keys.sample[k] = 0;
        }
        DrawBatch draws;
        VectorBatch cosines;
        draw_batch(8, keys, kDrawBatch, 0, Stream::scatter, draws);
        cosine_hemisphere_batch(draws, kDrawBatch, cosines);
        ViewWalk::ScatterBatch<true, true> scatter;
        scatter.clear();
        std::array<bool, kDrawBatch> drawn;
        for (std::uint32_t k = 0; k < kDrawBatch; ++k)
            drawn[k] =
                scatter.draw(surface_, guide_, guidance_, to_unit(draws[k][0]), draws[k], cosines[k], samples_[k]);
        scatter.convert(guide_);
        for (std::uint32_t k = 0; k < kDrawBatch; ++k) {
            samples_[k].f_cos = drawn[k] ? samples_[k].f_cos : Rgb(0.0f);
            if (drawn[k]) scatter.complete(surface_, guide_, guidance_, samples_[k]);
        }
    }

    const TestSurface& surface_;
    const SdTreeSampler& guide_;
    ViewGuidance guidance_;
    std::uint32_t batch_ = ~0u;
    std::array<ViewScatter, kDrawBatch> samples_;
};

TEST(GuideDistribution, MixtureFollowsItsDensity) {
    const TestSurface surface(grey(0.5f, false), {0.3f, -0.4f, 0.2f}, {0.1f, 0.5f, 0.9f});
    for (const float fraction : {0.1f, 0.5f, 1.0f}) {
        const SdTreeSampler& guide = trained_guide();
        MixtureSamples samples(surface, guide, guide.region_count() / 3, fraction);
        const auto sample = [&](std::uint32_t i, Vec3& d) {
            const ViewScatter& s = samples[i];
            d = s.world;
            return !is_black(s.f_cos);
        };
        // Directions of the guide below the surface are sampled and discarded: the density counts above it only.
        const auto density = [&](const Vec3& d) {
            const Vec3 local = surface.frame().to_local(d);
            return local.z > 0.0f ? samples.pdf(surface.bsdf().value(surface.wo(), local).pdf, direction_to_code(d))
                                  : 0.0f;
        };
        const auto result = test::test_directions(sample, density, kBsdfSamples, 16, 64);
        EXPECT_NEAR(result.integral, result.success, 3e-3);
        EXPECT_GT(result.p_value, kBsdfSignificance) << "fraction " << fraction;
    }
}

TEST(GuideDistribution, MixtureWithAViewFollowsItsDensity) {
    static const SdTreeSampler guide(test::random_view_tree(5, 60000, 1500, 4000, 2));
    const TestSurface surface(grey(0.5f, false), {0.3f, -0.4f, 0.2f}, {0.1f, 0.5f, 0.9f});
    std::uint32_t region = guide.region_count() / 2;
    while (guide.view(region, 0) == SdTreeSampler::kNoView)
        ++region;
    for (const ViewGuidance& guidance : {ViewGuidance{{region, 0.2f}, {guide.view(region, 77), 0.5f}},
                                         ViewGuidance{{region, 0.05f}, {guide.view(region, 0xc0000000u), 0.95f}},
                                         ViewGuidance{{region, 0.5f}, {guide.view(region, 0x80000000u), 0.0f}}}) {
        MixtureSamples samples(surface, guide, guidance);
        const auto sample = [&](std::uint32_t i, Vec3& d) {
            const ViewScatter& s = samples[i];
            d = s.world;
            if (is_black(s.f_cos)) return false;
            EXPECT_EQ(s.pdf, samples.pdf(surface.bsdf().value(surface.wo(), s.local).pdf, s.code));
            return true;
        };
        const auto density = [&](const Vec3& d) {
            const Vec3 local = surface.frame().to_local(d);
            return local.z > 0.0f ? samples.pdf(surface.bsdf().value(surface.wo(), local).pdf, direction_to_code(d))
                                  : 0.0f;
        };
        const auto result = test::test_directions(sample, density, kBsdfSamples, 16, 64);
        EXPECT_NEAR(result.integral, result.success, 3e-3);
        EXPECT_GT(result.p_value, kBsdfSignificance) << guidance.bsdf_fraction << ' ' << guidance.fraction;
    }
}

TEST(GuideDistribution, SampleAndDensityOfTheMixtureAgree) {
    const SdTreeSampler& guide = trained_guide();
    const TestSurface surface(grey(0.5f, true), {-0.3f, 0.4f, -0.8f}, {0.1f, 0.5f, -0.9f});
    MixtureSamples samples(surface, guide, 1, 0.5f);
    int at_borders = 0;
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const ViewScatter& s = samples[i];
        if (is_black(s.f_cos)) continue;
        ASSERT_EQ(s.pdf, samples.pdf(surface.bsdf().value(surface.wo(), s.local).pdf, s.code));
        at_borders += s.code != direction_to_code(s.world);
    }
    EXPECT_LT(at_borders, 20000) << "codes differ from those of the rounded directions by a step at most, and seldom";
}

TEST(BsdfDistribution, TheTestCanFail) {
    const PlainDiffuse bsdf = grey(0.5f, false);
    const auto sample = [&](std::uint32_t i, Vec3& d) {
        d = bsdf.sample(Vec3(0, 0, 1), {0.0f, uniform_draw(i)}).wi;
        return true;
    };
    const auto tilted = [](const Vec3& d) { return d.z > 0 ? (d.z + 0.02 * d.x) / M_PI : 0.0; };
    EXPECT_LT(test::test_directions(sample, tilted, kBsdfSamples).p_value, kBsdfSignificance);
}

}  // namespace
}  // namespace treefarm
