// SPDX-License-Identifier: Apache-2.0
// One of several directions: what it estimates, and how often it takes which.
#include <gtest/gtest.h>

#include <cmath>

#include "common/math/frame.h"
#include "tests/support/chi_square.h"
#include "tests/support/random_tree.h"
#include "worker/integrators/path/candidates.h"
#include "worker/shading/plain_diffuse.h"

namespace treefarm {
namespace {

/// A sample all of whose members have a value.
ScatterSample empty_sample() {
    ScatterSample s{};
    s.local = s.world = Vec3(0.0f);
    s.f_cos = Rgb(0.0f);
    return s;
}

void offer(Candidates<ScatterSample>& candidates, const ScatterSample& s) {
    candidates.next() = s;
    candidates.offer();
}

constexpr std::uint32_t kResamplingSamples = 400000;
constexpr float kFraction = 0.4f;

/// A diffuse surface under a tree that has learned some other light.
struct ShadedPoint {
    PlainDiffuse bsdf{Rgb(0.5f), false};
    Frame frame{normalize(Vec3(0.3f, -0.4f, 0.2f))};
    Vec3 wo{normalize(Vec3(0.1f, 0.5f, 0.9f))};
    SdTreeSampler guide{test::random_tree(5, 60000, 1500, 2)};
    std::uint32_t region = guide.region_count() / 3;

    /// All that sampling knows of a direction.
    ScatterSample at(const Vec3& world) const {
        ScatterSample s{};
        s.world = world;
        s.local = frame.to_local(world);
        const BsdfValue b = bsdf.value(wo, s.local);
        s.f_cos = b.f_cos;
        s.bsdf_pdf = b.pdf;
        s.guide_pdf = guide.pdf(region, direction_to_code(world));
        s.pdf = mixed_pdf(kFraction, s.bsdf_pdf, s.guide_pdf);
        return s;
    }

    ScatterSample draw_one(const Draw& r) const {
        if (!(to_unit(r[0]) < kFraction)) return at(guide.sample(region, r[1], r[2], r[3]).direction);
        return at(frame.to_world(bsdf.sample(wo, {to_unit(r[1]), {to_unit(r[2]), to_unit(r[3])}}).wi));
    }

    /// Draws one of `count` candidates; false if nothing was found.
    bool draw_of(std::uint32_t count, std::uint32_t i, ScatterSample& s) const {
        Candidates<ScatterSample> candidates;
        const PathKey key{3, i, count};
        for (std::uint32_t c = 0; c < count; ++c)
            offer(candidates, draw_one(draw(key, c, Stream::scatter)));
        return candidates.take(count, to_unit(draw(key, 0, Stream::candidate)[0]), s);
    }
};

const ShadedPoint& shaded_point() {
    static const ShadedPoint p;
    return p;
}

/// Sum over the sphere of function(direction) times solid angle.
template <class Function>
void over_sphere(Function function) {
    constexpr int kRows = 600, kColumns = 1200;
    const double area = 4 * M_PI / (kRows * kColumns);
    for (int row = 0; row < kRows; ++row)
        for (int column = 0; column < kColumns; ++column) {
            const double z = (row + 0.5) / kRows * 2 - 1, phi = (column + 0.5) / kColumns * 2 * M_PI;
            const double r = std::sqrt(1 - z * z);
            function(Vec3(static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)),
                          static_cast<float>(z)),
                     area);
        }
}

double light(const Vec3& d) {
    return 0.2 + 5 * std::pow(std::max(0.0f, dot(d, normalize(Vec3(0.2f, -0.3f, 0.9f)))), 16);
}

TEST(Resampling, EstimatesTheIntegralWithAnyNumberOfCandidates) {
    double exact = 0;
    over_sphere([&](const Vec3& d, double area) { exact += average(shaded_point().at(d).f_cos) * light(d) * area; });
    for (const std::uint32_t count : {1u, 2u, 3u, 4u}) {
        double sum = 0, squares = 0;
        for (std::uint32_t i = 0; i < kResamplingSamples; ++i) {
            ScatterSample s;
            const double x =
                shaded_point().draw_of(count, i, s) ? average(s.f_cos) * light(s.world) / double(s.effective_pdf) : 0.0;
            sum += x;
            squares += x * x;
        }
        const double mean = sum / kResamplingSamples, variance = squares / kResamplingSamples - mean * mean;
        EXPECT_LT(std::abs(mean - exact), 4 * std::sqrt(variance / kResamplingSamples)) << count << " candidates";
    }
}

TEST(Resampling, OneCandidateIsTheSampleItself) {
    for (std::uint32_t i = 0; i < 1000; ++i) {
        ScatterSample s;
        const ScatterSample one = shaded_point().draw_one(draw({3, i, 1}, 0, Stream::scatter));
        const bool found = shaded_point().draw_of(1, i, s);
        EXPECT_EQ(found, one.pdf > 0.0f && !is_black(one.f_cos));
        if (!found) continue;
        EXPECT_EQ(s.world, one.world);
        EXPECT_NEAR(s.effective_pdf, one.pdf, 1e-6f * one.pdf);
    }
}

/// p(y) = 2 q(y) G(w(y)), G(w) = integral of q(z) (0.8 w / (w + w(z)) + 0.1) dz, where z reflects, and of q(z) where
/// it does not: y came first or second, and was taken against z.
TEST(Resampling, TheBetterOfTwoFollowsItsDensity) {
    const auto weight = [&](const ScatterSample& s) {
        return s.pdf > 0.0f ? double(average(s.f_cos)) * (s.guide_pdf + 1.0 / (4 * M_PI)) / s.pdf : 0.0;
    };
    // How probable it is that w(z) is about 2^(k / 64 - 24), or 0.
    std::array<double, 64 * 48> histogram{};
    double of_nothing = 0;
    over_sphere([&](const Vec3& d, double area) {
        const ScatterSample s = shaded_point().at(d);
        const double w = weight(s);
        const int k = w > 0 ? static_cast<int>(std::floor(64 * (std::log2(w) + 24))) : -1;
        (k >= 0 ? histogram.at(static_cast<std::size_t>(k)) : of_nothing) += double(s.pdf) * area;
    });
    const auto density = [&](const Vec3& d) {
        const ScatterSample s = shaded_point().at(d);
        const double w = weight(s);
        if (!(w > 0)) return 0.0f;
        double taken = of_nothing;
        for (std::size_t k = 0; k < histogram.size(); ++k)
            if (histogram[k] > 0)
                taken += histogram[k] * (0.8 * w / (w + std::exp2((double(k) + 0.5) / 64 - 24)) + 0.1);
        return static_cast<float>(2 * s.pdf * taken);
    };
    const auto sample = [&](std::uint32_t i, Vec3& d) {
        ScatterSample s;
        const bool found = shaded_point().draw_of(2, i, s);
        d = s.world;
        return found;
    };
    const auto result = test::test_directions(sample, density, kResamplingSamples, 16, 16);
    EXPECT_NEAR(result.integral, result.success, 3e-3);
    EXPECT_GT(result.p_value, 1e-4);
}

TEST(Resampling, NothingWorthTakingIsNothing) {
    Candidates<ScatterSample> candidates;
    ScatterSample s = empty_sample();
    EXPECT_FALSE(candidates.take(2, 0.5f, s));
    s.f_cos = Rgb(1.0f);  // without density
    offer(candidates, s);
    s.f_cos = Rgb(0.0f);  // black
    s.pdf = 1.0f;
    offer(candidates, s);
    s.pdf = std::numeric_limits<float>::quiet_NaN();
    offer(candidates, s);
    EXPECT_FALSE(candidates.take(4, 0.5f, s));
}

TEST(Resampling, ProductsBeyondFloatsStillChoose) {
    for (const float f : {1e-42f, 1e-36f, 1e38f}) {
        ScatterSample sample{};
        sample.local = sample.world = Vec3(0.0f);
        sample.f_cos = Rgb(f);
        sample.pdf = 1.0f;
        sample.guide_pdf = f > 1.0f ? 1e6f : 1.0f;
        Candidates<ScatterSample> candidates;
        offer(candidates, sample);
        offer(candidates, sample);
        ScatterSample taken;
        ASSERT_TRUE(candidates.take(2, 0.7f, taken));
        EXPECT_NEAR(taken.effective_pdf, 1.0f, 1e-5f) << f;
    }
}

TEST(Resampling, NoDirectionWeighsMuchMoreThanAlone) {
    ScatterSample bright = empty_sample(), dark = empty_sample();
    bright.f_cos = dark.f_cos = Rgb(1.0f);
    bright.pdf = dark.pdf = 1.0f;
    bright.guide_pdf = 1e6f;
    for (const float u : {0.0f, 0.5f, 0.89f, 0.91f, 0x1.fffffep-1f}) {
        Candidates<ScatterSample> candidates;
        offer(candidates, bright);
        offer(candidates, dark);
        ScatterSample s;
        ASSERT_TRUE(candidates.take(2, u, s));
        EXPECT_EQ(s.guide_pdf == 0.0f, u > 0.9f) << u;
        EXPECT_NEAR(s.effective_pdf, u > 0.9f ? 0.2f : 1.8f, 1e-4f);
    }
}

}  // namespace
}  // namespace treefarm
