#include "worker/shading/bsdf.h"

#include <gtest/gtest.h>

#include "common/base/random.h"
#include "tests/support/chi_square.h"

namespace treefarm {
namespace {

constexpr double kSignificance = 1e-4;
constexpr std::uint32_t kSamples = 500000;

Vec2 uniform(std::uint32_t i) {
    const Draw r = draw({7, i, 0}, 0, Stream::scatter);
    return {to_unit(r[2]), to_unit(r[3])};
}

Bsdf grey(float reflectance, bool twosided) {
    Bsdf bsdf;
    bsdf.kind = Bsdf::Kind::diffuse;
    bsdf.twosided = twosided;
    bsdf.reflectance = Rgb(reflectance);
    return bsdf;
}

TEST(BsdfDistribution, SamplesFollowTheDensity) {
    for (const bool twosided : {false, true})
        for (const Vec3& wo : {Vec3(0, 0, 1), normalize(Vec3(1, 0.3f, 0.01f)), normalize(Vec3(-0.2f, 0.5f, -0.6f))}) {
            const Bsdf bsdf = grey(0.5f, twosided);
            const auto sample = [&](std::uint32_t i, Vec3& d) {
                const BsdfSample s = bsdf_sample(bsdf, wo, uniform(i));
                d = s.wi;
                return s.pdf > 0.0f;
            };
            const auto result = test::test_directions(
                sample, [&](const Vec3& d) { return bsdf_pdf(bsdf, wo, d); }, kSamples);
            const bool visible = wo.z > 0.0f || twosided;
            EXPECT_NEAR(result.integral, visible ? 1.0 : 0.0, 1e-3);
            EXPECT_NEAR(result.success, visible ? 1.0 : 0.0, 1e-5);
            EXPECT_GT(result.p_value, kSignificance);
        }
}

TEST(BsdfDistribution, SamplesAndDensityAreOfTheSameBsdf) {
    const Bsdf bsdf = grey(0.7f, true);
    const Vec3 wo = normalize(Vec3(0.3f, 0.1f, -0.8f));
    for (std::uint32_t i = 0; i < 10000; ++i) {
        const BsdfSample s = bsdf_sample(bsdf, wo, uniform(i));
        if (!(s.pdf > 0.0f)) continue;
        ASSERT_EQ(s.pdf, bsdf_pdf(bsdf, wo, s.wi));
        ASSERT_EQ(s.f_cos, bsdf_eval(bsdf, wo, s.wi));
    }
}

TEST(BsdfDistribution, ReflectsItsReflectanceAndNoMore) {
    for (const float reflectance : {0.0f, 0.3f, 1.0f}) {
        Bsdf bsdf = grey(reflectance, false);
        double sum = 0;
        constexpr int kSteps = 512;
        for (int y = 0; y < kSteps; ++y)
            for (int x = 0; x < kSteps; ++x) {
                const Vec3 d = square_to_sphere({(float(x) + 0.5f) / kSteps, (float(y) + 0.5f) / kSteps});
                sum += bsdf_eval(bsdf, normalize(Vec3(1, 1, 1)), d).x;
            }
        EXPECT_NEAR(sum * 4 * M_PI / (kSteps * kSteps), reflectance, 1e-4);
    }
}

TEST(BsdfDistribution, TheTestCanFail) {
    const Bsdf bsdf = grey(0.5f, false);
    const auto sample = [&](std::uint32_t i, Vec3& d) {
        d = bsdf_sample(bsdf, Vec3(0, 0, 1), uniform(i)).wi;
        return true;
    };
    const auto tilted = [](const Vec3& d) { return d.z > 0 ? (d.z + 0.02 * d.x) / M_PI : 0.0; };
    EXPECT_LT(test::test_directions(sample, tilted, kSamples).p_value, kSignificance);
}

}  // namespace
}  // namespace treefarm
