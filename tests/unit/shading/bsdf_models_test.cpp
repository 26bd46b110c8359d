// SPDX-License-Identifier: Apache-2.0
// Models of reflection where their papers, or other models, say what they come to.
#include <gtest/gtest.h>

#include "tests/support/bsdf_samples.h"
#include "tests/support/material_scenes.h"

namespace treefarm {
namespace {

using test::at_cosine;
using test::mean_power;
using test::PreparedMaterial;
using test::rough;

/// Smooth facets are Lambert's; the long form of a white surface keeps more than the short one, which lets no light go
/// from facet to facet (Oren and Nayar 1994, figure 12: against the light it is as bright as Lambert's, or brighter).
TEST(BsdfModels, RoughDiffuseIsOrenAndNayars) {
    const PreparedMaterial smooth(RoughDiffuseMaterial{Rgb(0.7f), {0.0f}}),
        rough_one(RoughDiffuseMaterial{Rgb(0.7f), {0.5f}}), fast(RoughDiffuseMaterial{Rgb(0.7f), {0.5f}, true});
    for (const float cos : {1.0f, 0.6f, 0.2f}) {
        const Vec3 wo = at_cosine(cos, 0.5f), wi = at_cosine(0.4f, 2.0f);
        EXPECT_NEAR(smooth.front().value(wo, wi).f_cos.x, 0.7f * 0.4f * kInvPi, 1e-6f);
        EXPECT_GT(mean_power(rough_one.front(), wo, 4000), mean_power(fast.front(), wo, 4000));
    }
    // Back to the light rough surfaces are brighter, across from it darker.
    const Vec3 grazing = at_cosine(0.3f, 0.0f), back = at_cosine(0.3f, 0.1f), across = at_cosine(0.3f, 3.1f);
    EXPECT_GT(rough_one.front().value(grazing, back).f_cos.x, 1.2f * rough_one.front().value(grazing, across).f_cos.x);
    // sigma^2 = 0.125, normal incidence and view: A of equation 30.
    const Vec3 up(0.0f, 0.0f, 1.0f);
    EXPECT_NEAR(fast.front().value(up, up).f_cos.x, 0.7f * kInvPi * (1 - 0.5f * 0.125f / 0.455f), 1e-6f);
}

/// The corners where the model is one that is known otherwise.
TEST(BsdfModels, PrincipledContainsMetalAndGlass) {
    PrincipledMaterial metal;
    metal.base_color = Rgb(0.9f, 0.6f, 0.3f);
    metal.metallic = 1.0f;
    metal.roughness = 0.5f;
    const PreparedMaterial principled_metal(metal),
        mirror(ConductorMaterial{Rgb(0.0f), Rgb(1.0f), Rgb(1.0f), rough(Microfacets::ggx, 0.25f, 0.25f)});
    PrincipledMaterial glass;
    glass.base_color = Rgb(1.0f);
    glass.spec_trans = 1.0f;
    glass.roughness = 0.5f;
    const PreparedMaterial principled_glass(glass),
        boundary(DielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), rough(Microfacets::ggx, 0.25f, 0.25f)});
    for (std::uint32_t i = 0; i < 300; ++i) {
        const Draw r = draw({19, i, 0}, 0, Stream::scatter);
        const Vec3 wo = at_cosine(0.05f + 0.9f * to_unit(r[0]), 6.28f * to_unit(r[1]));
        const Vec3 wi = at_cosine(0.05f + 0.9f * to_unit(r[2]), 6.28f * to_unit(r[3]));
        // Schlick's approximation between the color at the normal and white.
        const Vec3 h = normalize(wo + wi);
        const float weight = std::pow(1.0f - dot(wo, h), 5.0f);
        const Rgb expected =
            mirror.front().value(wo, wi).f_cos * (metal.base_color.value * (1.0f - weight) + Rgb(weight));
        const Rgb seen = principled_metal.front().value(wo, wi).f_cos;
        ASSERT_NEAR((seen - expected).length(), 0.0f, 1e-4f * (1.0f + expected.length()));
        for (const bool back : {false, true})
            for (const Vec3& to : {wi, Vec3(wi.x, wi.y, -wi.z)}) {
                const BsdfValue a = principled_glass.side(back)->value(wo, to), b = boundary.side(back)->value(wo, to);
                ASSERT_NEAR(a.f_cos.x, b.f_cos.x, 1e-4f * (1.0f + b.f_cos.x)) << back << to;
                ASSERT_NEAR(a.pdf, b.pdf, 1e-4f * (1.0f + b.pdf)) << back << to;
            }
    }
}

/// All that passes leaves on the other side, evenly; half of it within the cone of 45 degrees.
TEST(BsdfModels, ADiffuseTransmitterShinesEvenlyOnTheOtherSide) {
    const PreparedMaterial paper(DiffuseTransmitterMaterial{Rgb(0.75f, 0.5f, 0.25f)});
    int inner = 0;
    constexpr std::uint32_t kCount = 20000;
    for (std::uint32_t i = 0; i < kCount; ++i) {
        const Draw r = draw({23, i, 0}, 0, Stream::scatter);
        const Vec3 wo = at_cosine(0.01f + 0.99f * to_unit(r[0]), 6.28f * to_unit(r[1]));
        const BsdfSample s = paper.side(i % 2 == 1)->sample(wo, BsdfRandom{0.5f, {to_unit(r[2]), to_unit(r[3])}});
        ASSERT_LT(s.wi.z, 0.0f);
        ASSERT_FALSE(s.delta);
        ASSERT_NEAR(s.f_cos.x / s.pdf, 0.75f, 1e-5f);
        ASSERT_NEAR(s.f_cos.z, 0.25f * kInvPi * -s.wi.z, 1e-6f);
        ASSERT_EQ(paper.front().value(wo, {s.wi.x, s.wi.y, -s.wi.z}).pdf, 0.0f) << "nothing is reflected";
        inner += s.wi.z < -std::sqrt(0.5f);
    }
    EXPECT_NEAR(inner, 0.5 * kCount, 4 * std::sqrt(0.25 * kCount));
}

/// The corners of a thin sheet: paper that lets half of its diffuse light pass, and a rough pane.
TEST(BsdfModels, ThinPrincipledContainsPaperAndPane) {
    PrincipledThinMaterial paper;
    paper.base_color = Rgb(0.8f);
    paper.diff_trans = 1.0f;
    PrincipledThinMaterial pane;
    pane.base_color = Rgb(1.0f, 0.5f, 0.25f);
    pane.spec_trans = 1.0f;
    pane.roughness = 0.5f;
    pane.eta = 1.0f / 0.65f;  // what passes is as rough as 0.65 of this: 1 - 0.35
    const float alpha = 0.25f, through = (0.65f * 0.5f) * (0.65f * 0.5f);
    const PreparedMaterial thin_paper(paper), thin_pane(pane),
        mirror(ConductorMaterial{Rgb(0.0f), Rgb(1.0f), Rgb(1.0f), rough(Microfacets::ggx, alpha, alpha)}),
        turned(ConductorMaterial{Rgb(0.0f), Rgb(1.0f), Rgb(1.0f), rough(Microfacets::ggx, through, through)});
    for (std::uint32_t i = 0; i < 300; ++i) {
        const Draw r = draw({19, i, 0}, 0, Stream::scatter);
        const Vec3 wo = at_cosine(0.3f + 0.65f * to_unit(r[0]), 6.28f * to_unit(r[1]));
        const Vec3 wi = at_cosine(0.3f + 0.65f * to_unit(r[2]), 6.28f * to_unit(r[3]));
        const Vec3 below(wi.x, wi.y, -wi.z), h = normalize(wo + wi);
        for (const bool back : {false, true}) {
            const Bsdf &sheet = *thin_paper.side(back), &glass = *thin_pane.side(back);
            ASSERT_NEAR(sheet.value(wo, below).f_cos.x, 0.4f * wi.z * kInvPi, 1e-6f);
            const float f = fresnel_dielectric(std::min(1.0f, dot(wo, h)), 1.0f / 0.65f).reflectance;
            const float up = f * mirror.front().value(wo, wi).f_cos.x;
            ASSERT_NEAR(glass.value(wo, wi).f_cos.y, up, 1e-4f * (1.0f + up));
            // Dropped where the facet does not see it from behind.
            const float down = dot(below, h) < 0.0f ? 0.5f * (1.0f - f) * turned.front().value(wo, wi).f_cos.x : 0.0f;
            ASSERT_NEAR(glass.value(wo, below).f_cos.y, down, 1e-4f * (1.0f + down));
        }
    }
    EXPECT_LT(mean_power(thin_pane.front(), at_cosine(0.7f, 0.0f), 20000), 1.0);
}

/// Burley 2012: at grazing retroreflection a rough base is up to 2.5 times as bright as Lambert's, a smooth one half.
TEST(BsdfModels, PrincipledBaseIsBurleys) {
    PrincipledMaterial base;
    base.base_color = Rgb(1.0f);
    const Vec3 grazing = at_cosine(0.02f, 0.0f);
    for (const float roughness : {0.0f, 1.0f}) {
        base.roughness = roughness;
        const PreparedMaterial principled(base);
        const double lambert = 0.02 / 3.14159265, weight = std::pow(0.98, 5), retro = 2.0 * double(roughness);
        // Back where it came from; what the facets mirror is taken off by a base of no color.
        PrincipledMaterial black = base;
        black.base_color = Rgb(0.0f);
        const PreparedMaterial specular(black);
        const double seen = double(principled.front().value(grazing, grazing).f_cos.x) -
                            double(specular.front().value(grazing, grazing).f_cos.x);
        const double expected =
            (1 - 0.5 * weight) * (1 - 0.5 * weight) + retro * (2 * weight + weight * weight * (retro - 1));
        EXPECT_NEAR(seen / lambert, expected, 1e-3 * expected) << roughness;
    }
}

/// All of Phong's lobe about the normal lies above the surface: with its exponent the reflectance does not change.
TEST(BsdfModels, PhongAndWardReflectWhatTheyPromise) {
    const Vec3 up(0.0f, 0.0f, 1.0f);
    for (const float exponent : {1.0f, 20.0f, 1e3f, 1e5f}) {
        const PreparedMaterial phong(PhongMaterial{Rgb(0.0f), Rgb(0.8f), {exponent}});
        EXPECT_NEAR(mean_power(phong.front(), up, 20000), 0.8, 0.02) << exponent;
    }
    for (const float alpha : {0.01f, 0.1f, 0.3f}) {
        const PreparedMaterial ward(
            WardMaterial{Rgb(0.0f), Rgb(0.8f), WardVariant::balanced, rough(Microfacets::beckmann, alpha, alpha)});
        EXPECT_NEAR(mean_power(ward.front(), at_cosine(0.8f, 1.0f), 20000), 0.8, alpha < 0.2f ? 0.02 : 0.1) << alpha;
    }
    // The three variants agree where wo and wi mirror each other about the normal, but for what they are divided by.
    const Vec3 wo = at_cosine(0.5f, 0.0f), wi(-wo.x, -wo.y, wo.z);
    for (const WardVariant variant : {WardVariant::ward, WardVariant::duer, WardVariant::balanced}) {
        const PreparedMaterial ward(
            WardMaterial{Rgb(0.0f), Rgb(1.0f), variant, rough(Microfacets::beckmann, 0.2f, 0.2f)});
        const float peak = kInvPi / (0.2f * 0.2f), expected = variant == WardVariant::ward ? 0.25f : 0.5f;
        EXPECT_NEAR(ward.front().value(wo, wi).f_cos.x / peak, expected, 1e-5f);
    }
}

/// Henyey and Greenstein's formula as it stands, with directions that point away from where light is scattered.
TEST(BsdfModels, ThePhaseFunctionIsHenyeyAndGreensteins) {
    const Vec3 wo = at_cosine(0.6f, 0.5f);
    for (const float g : {-0.7f, 0.0f, 0.4f, 0.7f}) {
        const HenyeyGreenstein phase{g};
        double forwards = 0;
        constexpr std::uint32_t kCount = 20000;
        for (std::uint32_t i = 0; i < kCount; ++i) {
            const Vec3 wi = phase.sample(wo, test::uniform(i).point);
            const double cos = -double(dot(wo, wi)), d = 1.0 + double(g) * double(g) - 2.0 * double(g) * cos;
            const double expected = (1.0 - double(g) * double(g)) / (4.0 * double(kPi) * d * std::sqrt(d));
            ASSERT_NEAR(double(phase.value(wo, wi)), expected, 1e-4 * expected) << "g " << g << ", cos " << cos;
            forwards += cos / kCount;
        }
        EXPECT_NEAR(forwards, double(g), 0.015);
    }
}

/// Powers that leave a layer by either side after light was scattered once, and what passes unscattered: where it is
/// scattered is summed over, its direction drawn.
struct LayerPower {
    double back = 0, on = 0, straight = 0;
};

LayerPower scattered_once(double depth, double albedo, double cos_o, const HenyeyGreenstein& phase) {
    constexpr int kDirections = 20000, kDepths = 32;
    LayerPower power{0, 0, std::exp(-depth / cos_o)};
    for (int i = 0; i < kDirections; ++i) {
        const Vec3 wi = phase.sample(at_cosine(static_cast<float>(cos_o), 0.5f),
                                     test::uniform(static_cast<std::uint32_t>(i)).point);
        for (int k = 0; k < kDepths; ++k) {
            // Depths at which light is scattered, equally likely.
            const double share = (k + 0.5) / kDepths * (1.0 - power.straight), deep = -std::log(1.0 - share) * cos_o;
            const double way = wi.z > 0.0f ? deep / double(wi.z) : (depth - deep) / double(-wi.z);
            (wi.z > 0.0f ? power.back : power.on) +=
                albedo * (1.0 - power.straight) * std::exp(-way) / (kDirections * kDepths);
        }
    }
    return power;
}

/// Hanrahan and Krueger's closed forms against what they are the integrals of.
TEST(BsdfModels, AThinLayerScattersOnce) {
    constexpr std::uint32_t kCount = 60000;
    for (const float g : {-0.5f, 0.0f, 0.8f})
        for (const float depth : {0.05f, 0.7f, 4.0f})
            for (const float cos : {1.0f, 0.4f}) {
                const float albedo = 0.8f;
                const PreparedMaterial layer(ThinLayerMaterial{Rgb(albedo * depth), Rgb((1.0f - albedo) * depth), {g}});
                LayerPower sampled;
                for (std::uint32_t i = 0; i < kCount; ++i) {
                    const BsdfSample s = layer.front().sample(at_cosine(cos, 0.5f), test::uniform(i));
                    if (!(s.pdf > 0.0f)) continue;
                    (s.delta         ? sampled.straight
                     : s.wi.z > 0.0f ? sampled.back
                                     : sampled.on) += double(s.f_cos.y) / double(s.pdf) / kCount;
                }
                const LayerPower expected = scattered_once(double(depth), double(albedo), double(cos), {g});
                const std::string at =
                    "g " + std::to_string(g) + ", depth " + std::to_string(depth) + ", cos " + std::to_string(cos);
                EXPECT_NEAR(sampled.straight, expected.straight, 0.01) << at;
                EXPECT_NEAR(sampled.back, expected.back, 0.06 * expected.back + 1e-3) << at;
                EXPECT_NEAR(sampled.on, expected.on, 0.06 * expected.on + 1e-3) << at;
            }
}

TEST(BsdfModels, AThinLayerWithoutWhatPassesOnlyReflects) {
    const ThinLayerMaterial layer{Rgb(0.5f), Rgb(0.25f), {0.5f}};
    const PreparedMaterial whole(layer), opaque(layer.opaque());
    const Vec3 wo = at_cosine(0.6f, 0.5f), wi = at_cosine(0.3f, 2.0f);
    EXPECT_EQ(opaque.front().value(wo, wi).f_cos, whole.front().value(wo, wi).f_cos);
    EXPECT_EQ(opaque.front().value(wo, -wi).f_cos, Rgb(0.0f));
    EXPECT_EQ(lobes_of(opaque.front()), kSmoothLobe | kViewLobe);
    EXPECT_EQ(opaque.side(true), nullptr);
}

}  // namespace
}  // namespace treefarm
