// SPDX-License-Identifier: Apache-2.0
// Fresnel's equations, rough transmittance and plastic against known values.
#include <gtest/gtest.h>

#include "common/base/random.h"
#include "common/math/exponential.h"
#include "tests/support/material_scenes.h"
#include "worker/shading/fresnel.h"
#include "worker/shading/rough_transmittance.h"

namespace treefarm {
namespace {

using test::PreparedMaterial;

TEST(Exponential, AgreesWithTheLibrary) {
    for (double x = 0; x < 86; x += 0.013)
        ASSERT_NEAR(double(exp_negative(static_cast<float>(x))) / std::exp(-double(static_cast<float>(x))), 1.0, 4e-7)
            << x;
    EXPECT_EQ(exp_negative(1000.0f), 0.0f);
    EXPECT_EQ(exp_negative(0.0f), 1.0f);
    for (double x = 0; x < 5; x += 0.003) {
        const auto f = double(static_cast<float>(x));
        ASSERT_NEAR(double(erfc_scaled(static_cast<float>(x))) / (std::exp(f * f) * std::erfc(f)), 1.0, 4e-7) << x;
    }
}

TEST(Exponential, LogarithmsAndDifferencesKeepTheirDigits) {
    for (float x = 1e-7f; x < 1.0f - 0x1p-24f; x = x < 0.9f ? x * 1.01f : 0.5f * (1.0f + x)) {
        ASSERT_NEAR(double(minus_log_one_minus(x)) / -std::log1p(-double(x)), 1.0, 1e-6) << x;
        ASSERT_NEAR(double(one_minus_exp_negative(x)) / -std::expm1(-double(x)), 1.0, 2e-6) << x;
    }
    for (float x = 1e-30f; x < 1.0f; x *= 1.013f)
        ASSERT_NEAR(double(minus_log(x)), -std::log(double(x)), 3e-7 * std::max(1.0, -std::log(double(x)))) << x;
    EXPECT_EQ(minus_log_one_minus(0.0f), 0.0f);
    EXPECT_EQ(one_minus_exp_negative(0.0f), 0.0f);
    EXPECT_EQ(one_minus_exp_negative(1e4f), 1.0f);
}

TEST(Fresnel, KnownReflectances) {
    EXPECT_NEAR(fresnel_dielectric(1.0f, 1.5f).reflectance, 0.04f, 1e-6f);
    EXPECT_NEAR(fresnel_dielectric(1.0f, 1 / 1.5f).reflectance, 0.04f, 1e-6f);
    EXPECT_EQ(fresnel_dielectric(0.0f, 1.5f).reflectance, 1.0f);
    EXPECT_EQ(fresnel_dielectric(0.5f, 1.0f).reflectance, 0.0f);
    // Brewster's angle: only half of the light, polarised across, is reflected.
    const float brewster = 1 / std::sqrt(1 + 1.5f * 1.5f);
    const float r = (1 - 1.5f * 1.5f) / (1 + 1.5f * 1.5f);
    EXPECT_NEAR(fresnel_dielectric(brewster, 1.5f).reflectance, 0.5f * r * r, 1e-6f);
    // Total internal reflection sets in where sin = 1 / 1.5.
    const float critical = std::sqrt(1 - 1 / (1.5f * 1.5f));
    EXPECT_EQ(fresnel_dielectric(critical - 1e-4f, 1 / 1.5f).reflectance, 1.0f);
    EXPECT_LT(fresnel_dielectric(critical + 1e-4f, 1 / 1.5f).reflectance, 0.95f);
    // A metal without absorption is glass; a perfect one reflects all; gold at normal incidence by its formula.
    for (const float cos : {0.1f, 0.4f, 0.8f, 1.0f}) {
        EXPECT_NEAR(fresnel_conductor(cos, 1.5f, 0.0f), fresnel_dielectric(cos, 1.5f).reflectance, 2e-6f);
        EXPECT_NEAR(fresnel_conductor(cos, 0.0f, 1.0f), 1.0f, 1e-6f);
    }
    const float eta = 0.143f, k = 3.98f;
    EXPECT_NEAR(fresnel_conductor(1.0f, eta, k), ((eta - 1) * (eta - 1) + k * k) / ((eta + 1) * (eta + 1) + k * k),
                1e-6f);
    EXPECT_NEAR(fresnel_conductor(0.0f, eta, k), 1.0f, 1e-6f);
}

TEST(Fresnel, EdgeOfTotalReflectionIsFinite) {
    for (int ulps = -4; ulps <= 4; ++ulps) {
        float cos = std::sqrt(1 - 1 / (1.5f * 1.5f));
        for (int i = 0; i < std::abs(ulps); ++i)
            cos = std::nextafter(cos, ulps < 0 ? 0.0f : 1.0f);
        const DielectricFresnel f = fresnel_dielectric(cos, 1 / 1.5f);
        EXPECT_TRUE(f.reflectance >= 0.9f && f.reflectance <= 1.0f && f.cos_transmitted >= 0.0f);
    }
}

TEST(RoughTransmittance, OfASmoothBoundaryIsFresnels) {
    const RoughTransmittance t(Microfacet{true, 1e-4f, 1e-4f}, 1.5f);
    for (const float cos : {0.1f, 0.3f, 0.5f, 0.9f, 1.0f})
        EXPECT_NEAR(t.at(cos), 1.0f - fresnel_dielectric(cos, 1.5f).reflectance, 2e-3f) << cos;
    double diffuse = 0;
    for (int i = 0; i < 100000; ++i) {
        const double cos = (i + 0.5) / 100000, t = std::sqrt(1 - (1 - cos * cos) / 2.25);
        const double s = (cos - 1.5 * t) / (cos + 1.5 * t), p = (1.5 * cos - t) / (1.5 * cos + t);
        diffuse += 2 * cos * (1 - 0.5 * (s * s + p * p)) / 100000;
    }
    EXPECT_NEAR(double(smooth_diffuse_transmittance(1.5f)), diffuse, 1e-6);
    EXPECT_NEAR(t.escapes(false) * 1.5f * 1.5f, smooth_diffuse_transmittance(1.5f), 1e-3f);
}

TEST(RoughTransmittance, AgreesWithTheRoughBoundary) {
    for (const Microfacets kind : {Microfacets::ggx, Microfacets::beckmann})
        for (const float alpha : {0.1f, 0.4f}) {
            const PreparedMaterial glass(
                DielectricMaterial{1.5f, Rgb(0.0f), Rgb(1.0f), test::rough(kind, alpha, alpha)});
            const RoughTransmittance table(Microfacet{kind == Microfacets::ggx, alpha, alpha}, 1.5f);
            for (const float cos : {0.1f, 0.5f, 1.0f}) {
                const Vec3 wo(std::sqrt(1 - cos * cos), 0.0f, cos);
                double sum = 0;
                constexpr int kSide = 400;
                for (int y = 0; y < kSide; ++y)
                    for (int x = 0; x < kSide; ++x) {
                        const Vec2 u((float(x) + 0.5f) / kSide, (float(y) + 0.5f) / kSide);
                        const float lobe =
                            to_unit(draw({31, static_cast<std::uint32_t>(y * kSide + x), 0}, 0, Stream::scatter)[0]);
                        const BsdfSample s = glass.front().sample(wo, {lobe, u});
                        if (s.pdf > 0.0f && s.wi.z < 0.0f) sum += double(s.f_cos.x / s.pdf) * 1.5 * 1.5;
                    }
                EXPECT_NEAR(sum / (kSide * kSide), double(table.at(cos)), 3e-3) << alpha << " " << cos;
            }
        }
}

/// Diffuse light that GGX facets reflect once into the half space of its origin, by Walter's formulas in double
/// precision, on cells of direction; as the sum over 64 cosines that Mitsuba 3 takes.
double ggx_reflects_once(double alpha, double eta) {
    const auto masking = [&](double cos) {
        return 2 / (1 + std::sqrt(1 + alpha * alpha * (1 - cos * cos) / (cos * cos)));
    };
    double sum = 0;
    for (int k = 1; k < 64; ++k) {
        const double cos_o = k / 63.0, sin_o = std::sqrt(1 - cos_o * cos_o);
        double reflected = 0;
        constexpr int kRows = 240, kColumns = 240;
        for (int y = 0; y < kRows; ++y)
            for (int x = 0; x < kColumns; ++x) {
                const double cos_i = (y + 0.5) / kRows, sin_i = std::sqrt(1 - cos_i * cos_i);
                const double azimuth = M_PI * (x + 0.5) / kColumns;
                const double h[3] = {sin_o + sin_i * std::cos(azimuth), sin_i * std::sin(azimuth), cos_o + cos_i};
                const double length = std::sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
                const double cos_h = h[2] / length, cos_m = (sin_o * h[0] + cos_o * h[2]) / length;
                const double slope = cos_h * cos_h * (alpha * alpha - 1) + 1;
                const double density = alpha * alpha / (M_PI * slope * slope);
                const double sin2_t = (1 - cos_m * cos_m) / (eta * eta);
                double fresnel = 1;
                if (sin2_t < 1) {
                    const double cos_t = std::sqrt(1 - sin2_t);
                    const double s = (cos_m - eta * cos_t) / (cos_m + eta * cos_t),
                                 p = (eta * cos_m - cos_t) / (eta * cos_m + cos_t);
                    fresnel = 0.5 * (s * s + p * p);
                }
                reflected += fresnel * density * masking(cos_o) * masking(cos_i) / (4 * cos_o);
            }
        sum += 2 * cos_o * reflected * 2 * M_PI / (kRows * kColumns);
    }
    return sum / 64;
}

TEST(Plastic, RoughCoatsReturnWhatTheirFacetsReflectOnce) {
    const Vec3 up(0, 0, 1);
    for (const float alpha : {0.1f, 0.3f, 1.0f}) {
        PlasticMaterial material{1.5f, Rgb(0.5f), Rgb(0.0f), false, test::rough(Microfacets::ggx, alpha, alpha)};
        const PreparedMaterial all(material);
        material.single_return = true;
        const PreparedMaterial single(material);
        const RoughTransmittance coat(Microfacet{true, alpha, alpha}, 1.5f);
        const double escapes = 1 - ggx_reflects_once(double(alpha), 1 / 1.5);
        EXPECT_NEAR(double(coat.escapes(true)), escapes, 1e-3) << alpha;
        // Bases are inversely proportional to what escapes.
        const float ratio = all.front().value(up, up).f_cos.x / single.front().value(up, up).f_cos.x;
        EXPECT_NEAR(ratio, coat.escapes(true) / coat.escapes(false), 1e-5f) << alpha;
        EXPECT_GT(ratio, 1.0f) << "less is left for the base";
    }
}

TEST(Plastic, LinearAndNonlinearBases) {
    const float escapes = smooth_diffuse_transmittance(1.5f) / (1.5f * 1.5f), fdr = 1 - escapes;
    // The same by what a boundary seen from inside reflects.
    EXPECT_NEAR(fdr, 1 - smooth_diffuse_transmittance(1 / 1.5f), 3e-5f);
    const Vec3 up(0, 0, 1);
    for (const bool nonlinear : {false, true}) {
        const PreparedMaterial plastic(PlasticMaterial{1.5f, Rgb(0.5f, 0.2f, 1.0f), Rgb(1.0f), nonlinear, {}});
        const BsdfValue v = plastic.front().value(up, up);
        const float passes = 0.96f * 0.96f / (1.5f * 1.5f) * kInvPi;
        for (const int k : {0, 1, 2}) {
            const float albedo = Rgb(0.5f, 0.2f, 1.0f)[k];
            EXPECT_NEAR(v.f_cos[k], passes * albedo / (1 - (nonlinear ? albedo : 1.0f) * fdr), 1e-5f);
        }
    }
}

/// White plastic loses nothing: what enters the base comes out in the end.
TEST(Plastic, WhiteKeepsItsEnergy) {
    for (const float alpha : {0.0f, 0.05f, 0.2f}) {
        const Roughness roughness = alpha > 0 ? test::rough(Microfacets::beckmann, alpha, alpha) : Roughness{};
        const PreparedMaterial plastic(PlasticMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), true, roughness});
        for (const float cos : {1.0f, 0.5f}) {
            const Vec3 wo(std::sqrt(1 - cos * cos), 0.0f, cos);
            double sum = 0;
            constexpr int kCount = 60000;
            for (std::uint32_t i = 0; i < kCount; ++i) {
                const Draw r = draw({19, i, 0}, 0, Stream::scatter);
                const BsdfSample s = plastic.front().sample(wo, {to_unit(r[1]), {to_unit(r[2]), to_unit(r[3])}});
                if (s.pdf > 0.0f) sum += double(s.f_cos.x) / double(s.pdf);
            }
            EXPECT_NEAR(sum / kCount, 1.0, 0.015) << alpha << " " << cos;
        }
    }
}

TEST(Plastic, VaryingRoughnessInterpolates) {
    Scene scene;
    const std::int32_t board = test::add_board(scene, Rgb(0.1f), Rgb(0.35f));
    PlasticMaterial material{1.5f, Rgb(0.3f), Rgb(1.0f), true, {}};
    material.roughness = test::rough(Microfacets::ggx, 1.0f, 1.0f);
    material.roughness.alpha_u = material.roughness.alpha_v = FloatInput(1.0f, board);
    test::add_material(scene, material);
    PreparedMaterial varying(scene);
    ASSERT_TRUE(varying.varies());
    const Vec3 wo = normalize(Vec3(1, 0, 1)), wi = normalize(Vec3(-1, 0.5f, 1));
    for (const auto& [u, alpha] : {std::pair{0.2f, 0.1f}, {0.7f, 0.35f}}) {
        material.roughness = test::rough(Microfacets::ggx, alpha, alpha);
        const PreparedMaterial constant(material);
        ShadingPoint point;
        point.uv = {u, 0.2f};
        point.wo = wo;
        const Rgb a = varying.at(point).value(wo, wi).f_cos, b = constant.front().value(wo, wi).f_cos;
        EXPECT_NEAR(a.x / b.x, 1.0f, 3e-3f);
    }
}

}  // namespace
}  // namespace treefarm
