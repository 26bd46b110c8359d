// SPDX-License-Identifier: Apache-2.0
// Fresnel's equations where they degenerate.
#include <random>

#include "common/base/error.h"
#include "coordinator/input/check/validate.h"
#include "tests/support/hard_case.h"
#include "tests/support/material_scenes.h"
#include "worker/integrators/path/glass_splits.h"
#include "worker/shading/fresnel.h"

namespace treefarm {
namespace {

using test::rough;

/// Fresnel's reflectance in long double, from the sine so that nothing cancels.
long double exact_reflectance(long double cos_i, long double eta) {
    const long double sin2_t = (1.0L - cos_i) * (1.0L + cos_i) / (eta * eta);
    if (sin2_t >= 1.0L) return 1.0L;
    const long double cos_t = std::sqrt(1.0L - sin2_t);
    const long double s = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    const long double p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    return 0.5L * (s * s + p * p);
}

/// 43 | The edge of total internal reflection
/// Others: sin^2 of the refracted angle a rounding step beyond 1 gave the root of a negative number (pbrt
/// FrDielectric).
/// Here: everything from sin^2 = 1 on reflects totally, and the root is taken below it only.
/// Holds: within 1000 steps of float around the critical cosine, for indices 0.01 to 0.999999, the reflectance is
/// in [0, 1] and within 1e-4 of the range of the exact ones for cosines whose squares differ by 4e-7.
TEST(Boundaries, EdgeOfTotalReflection) {
    test::Worst worst;
    for (const float eta : {0.01f, 0.5f, 1.0f / 1.5046f, 0.9f, 0.999f, 0.999999f}) {
        float cos = static_cast<float>(std::sqrt((1.0 - double(eta)) * (1.0 + double(eta))));
        for (int i = 0; i < 1000; ++i)
            cos = std::nextafter(cos, 0.0f);
        for (int i = 0; i < 2000; ++i, cos = std::nextafter(cos, 2.0f)) {
            if (cos > 1.0f) break;
            const DielectricFresnel f = fresnel_dielectric(cos, eta);
            ASSERT_TRUE(f.reflectance >= 0.0f && f.reflectance <= 1.0f) << eta << " " << cos;
            ASSERT_TRUE(f.cos_transmitted >= 0.0f && f.cos_transmitted <= 1.0f) << eta << " " << cos;
            // 1 - cos rounds by 6e-8: compare with what cosines whose squares differ by twice that have.
            const double step = 2e-7 / double(cos) + 2e-7 * double(cos);
            const auto at = [&](double c) {
                return double(exact_reflectance(std::clamp(c, 0.0, 1.0), static_cast<long double>(eta)));
            };
            const auto [low, high] = std::minmax({at(double(cos)), at(double(cos) - step), at(double(cos) + step)});
            const double value = double(f.reflectance);
            worst.see(std::max({0.0, low - value, value - high}), eta, cos);
        }
    }
    EXPECT_LT(worst.value, 1e-4) << worst.where;
    test::figure("largest distance from that range", worst.value);
}

/// 43 | Fresnel at any cosine and index
/// Others: cosines of 0 or slightly above 1, and very large indices, gave NaN.
/// Here: sums of positive terms are divided by, and checked to be positive.
/// Holds: reflectances are in [0, 1] for cosines 0 to 1 and indices 1e-6 to 1e6, at cosine 0 exactly 1 unless the
/// index is 1, and those of metals with eta and k from 0 to 1e6 too.
TEST(Boundaries, AnyCosineAndIndex) {
    float most = 0.0f;
    const float cosines[] = {0.0f, 1e-45f, 1e-30f, 1e-8f, 1e-4f, 0.1f, 0.5f, 0x1.fffffep-1f, 1.0f};
    const float indices[] = {1e-6f, 1e-3f, 0.5f, 0x1.fffffep-1f, 1.0f, 0x1.000002p0f, 1.5f, 1e3f, 1e6f};
    const float metal[] = {0.0f, 1e-20f, 1e-6f, 0.1f, 1.0f, 5.0f, 1e3f, 1e6f};
    for (const float cos : cosines) {
        for (const float eta : indices) {
            const float r = fresnel_dielectric(cos, eta).reflectance;
            ASSERT_TRUE(r >= 0.0f && r <= 1.0f) << cos << " " << eta << " " << r;
            if (cos == 0.0f) {
                ASSERT_EQ(r, 1.0f) << eta;
            }
        }
        for (const float eta : metal)
            for (const float k : metal) {
                const float r = fresnel_conductor(cos, eta, k);
                ASSERT_TRUE(r >= 0.0f && r <= 1.0f) << cos << " " << eta << " " << k << " " << r;
                most = std::max(most, r);
            }
    }
    test::figure("largest reflectance of a metal minus 1", double(most) - 1.0);
}

/// 43 | Metals whose indices overflow when squared
/// Others: [ours] eta or k of 1e10 passed every check and gave infinity minus infinity: black or invalid pixels.
/// Here: an index above 1e6 is refused with a place and a cure, as for glass.
/// Holds: 1e6 is accepted and finite; 1e7, 1e10, 1e20 and 3e38 are refused, for eta and for k.
TEST(Boundaries, IndicesOfMetalsAreBounded) {
    const LetFloatsBe hostile;  // numbers that are none come in
    const auto load = [](float eta, float k) {
        Scene scene;
        test::add_material(scene, ConductorMaterial{Rgb(eta), Rgb(k), Rgb(1.0f), {}});
        std::vector<Warning> warnings;
        validate_scene(scene, warnings);
    };
    EXPECT_NO_THROW(load(1e6f, 1e6f));
    int refused = 0;
    for (const float huge : {1e7f, 1e10f, 1e20f, 3e38f}) {
        EXPECT_THROW(load(huge, 1.0f), InputError) << huge;
        EXPECT_THROW(load(0.0f, huge), InputError) << huge;
        refused += 2;
    }
    test::figure("indices refused", refused);
}

/// 6 | Equal indices of refraction
/// Others: an index of 1 gave NaN or black in rough glass (Cycles #117611).
/// Here: within 1e-4 of 1 nothing refracts: the boundary lets all pass straight on.
/// Holds: smooth, thin and rough glass (alpha 0.01 to 1) with an index of 1, one float beside it, and up to 1 +-
/// 2e-3, pass on all power within 3 %, rough ones what their facets do not mask; smooth and thin ones bend by at
/// most 6 times the distance from 1; from both sides.
TEST(Boundaries, EqualIndicesAreInvisible) {
    test::Worst bent, lost;
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform;
    for (const float eta : {1.0f, 0x1.fffffep-1f, 0x1.000002p0f, 1.00001f, 0.9999f, 1.001f, 1.0011f, 0.9989f, 1.002f})
        for (int kind = 0; kind < 8; ++kind) {
            const Rgb white(1.0f);
            const Microfacets facets = kind % 2 == 0 ? Microfacets::ggx : Microfacets::beckmann;
            const float alpha = kind < 4 ? 0.01f : kind < 6 ? 0.3f : 1.0f;
            const test::PreparedMaterial material =
                kind == 0 ? test::PreparedMaterial(DielectricMaterial{eta, white, white, {}})
                : kind == 1
                    ? test::PreparedMaterial(ThinDielectricMaterial{eta, white, white})
                    : test::PreparedMaterial(DielectricMaterial{eta, white, white, rough(facets, alpha, alpha)});
            for (const bool back : {false, true})
                for (const float cos : {1.0f, 0.6f, 0.2f}) {
                    const Vec3 wo(std::sqrt(1.0f - cos * cos), 0.0f, cos);
                    double power = 0;
                    constexpr int kSamples = 2000;
                    for (int i = 0; i < kSamples; ++i) {
                        const BsdfSample s =
                            material.side(back)->sample(wo, {uniform(random), {uniform(random), uniform(random)}});
                        if (!(s.pdf > 0.0f)) continue;
                        ASSERT_TRUE(is_finite(s.f_cos) && std::isfinite(s.pdf) && is_finite(s.wi)) << eta << kind;
                        power += double(s.f_cos.x) / double(s.pdf) / kSamples;
                        const double off = std::max(1e-6, std::abs(double(eta) - 1.0));
                        if (s.wi.z < 0.0f && kind < 2) bent.see(double((s.wi + wo).length()) / off, eta, kind, cos);
                    }
                    const Microfacet shape{facets == Microfacets::ggx, alpha, alpha};
                    const double masked = kind < 2 || std::abs(eta - 1.0f) < 1e-4f ? 1.0 : double(shape.masking(wo));
                    lost.see(std::abs(power / masked - 1.0), eta, kind, cos);
                }
        }
    EXPECT_LT(bent.value, 6.0) << bent.where;
    EXPECT_LT(lost.value, 0.03) << lost.where;
    test::figure("largest relative error of the power", lost.value);
}

/// ours | Faint ways out of glass
/// Others: [ours] the lesser of two ways is followed by chance: at a probability of 1e-40 its weight is infinite.
/// Here: it is followed once in 4096 times at least.
/// Holds: weights are finite and at most a quarter (1 from a quarter on) for probabilities from 1e-45 to 1/2; a ball of
/// glass that mirrors between 1e-38 and 1e-3 before an even sky has no invalid sample, and lets all through within
/// 1e-3.
TEST(Boundaries, FaintWaysOutOfGlass) {
    for (int exponent = -149; exponent < 0; ++exponent) {
        const float p = std::ldexp(1.0f, exponent);
        const float weight = p * (1.0f / GlassSplits::chance(p));
        EXPECT_TRUE(std::isfinite(weight)) << p;
        EXPECT_LE(weight, p < 0.25f ? 0.25001f : 1.0f) << p;
    }
    double worst = 0;
    for (const float reflectance : {1e-38f, 1e-30f, 1e-20f, 1e-3f}) {
        Scene scene;
        test::add_shape(scene, Sphere{Vec3(0.0f), 1.0f},
                        test::add_material(scene, DielectricMaterial{1.01f, Rgb(reflectance), Rgb(1.0f), {}}));
        scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
        scene.camera = test::look_at({0, 0, -4}, Vec3(0.0f), {0, 1, 0}, 0.1f);
        test::set_film(scene, 16, 16);
        const test::LocalRender run = test::render_locally(scene, test::plain_job(64, 100));
        EXPECT_EQ(test::invalid_samples(run), 0u);
        worst = std::max(worst, std::abs(test::mean_of(run.image).value - 1.0));
    }
    EXPECT_LT(worst, 1e-3);
    test::figure("largest error of the mean", worst);
}

}  // namespace
}  // namespace treefarm
