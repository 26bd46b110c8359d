// SPDX-License-Identifier: Apache-2.0
// Every rough BSDF: samples against density, over roughness and angle, on both sides.
#include <gtest/gtest.h>

#include "common/base/random.h"
#include "tests/support/lobe_test.h"
#include "tests/support/material_scenes.h"

namespace treefarm {
namespace {

constexpr double kLobeSignificance = 1e-5;
constexpr std::uint32_t kLobeSamples = 40000;

BsdfRandom uniform_numbers(std::uint32_t i) {
    const Draw r = draw({11, i, 0}, 0, Stream::scatter);
    return {to_unit(r[1]), {to_unit(r[2]), to_unit(r[3])}};
}

Vec3 at_cosine(float cos, float azimuth) {
    const float sin = std::sqrt(1.0f - cos * cos);
    return normalize(Vec3(sin * std::cos(azimuth), sin * std::sin(azimuth), cos));
}

struct LobeCase {
    Microfacets distribution;
    float alpha;
};

void PrintTo(const LobeCase& c, std::ostream* out) {
    *out << (c.distribution == Microfacets::ggx ? "GGX" : "Beckmann") << " alpha " << c.alpha;
}

class RoughLobes : public ::testing::TestWithParam<LobeCase> {
  protected:
    /// Tests the lobe about `center` on its side of the surface.
    void test(const Bsdf& bsdf, const Vec3& wo, Vec3 center, float width, const char* what, bool on_base = false) {
        // Facets turn wi by less than floats of its direction tell.
        if (width * wo.z < 1e-6f) return;
        const float side = center.z;
        if (std::abs(side) < std::min(0.05f, 20 * width)) center.z = 0.0f;  // the horizon cuts the lobe
        // Reflection at grazing angles is narrow horizontally: facets turn wi by their tilt times cos(wo).
        const double across = double(side > 0.0f ? width * std::max(wo.z, std::min(0.5f * width, 1.0f)) : width);
        const auto sample = [&](std::uint32_t i, Vec3& d) {
            const BsdfSample s = bsdf.sample(wo, uniform_numbers(i));
            d = s.wi;
            return s.pdf > 0.0f && !s.delta && d.z * side > 0.0f;
        };
        const auto density = [&](const Vec3& d) { return d.z * side > 0.0f ? double(bsdf.value(wo, d).pdf) : 0.0; };
        const int sub = wo.z < 0.01f && (width < 0.05f || side < 0.0f) ? 100 : 32;
        const test::LobeTest result =
            on_base
                ? test::test_lobe(sample, density, normalize(center), across, double(width), kLobeSamples, 40, 16, true)
                : test::test_lobe(sample, density, normalize(center), across, double(width), kLobeSamples, 12, sub);
        EXPECT_GT(result.p_value, kLobeSignificance) << what << " wo.z " << wo.z;
        EXPECT_NEAR(result.integral, result.inside, 0.01) << what << " wo.z " << wo.z;
    }

    /// A lobe on a base that is as wide across as along.
    void test_round(const Bsdf& bsdf, const Vec3& wo, Vec3 center, float width, const char* what) {
        const float side = center.z;
        if (std::abs(side) < std::min(0.05f, 20 * width)) center.z = 0.0f;
        const auto sample = [&](std::uint32_t i, Vec3& d) {
            const BsdfSample s = bsdf.sample(wo, uniform_numbers(i));
            d = s.wi;
            return s.pdf > 0.0f && !s.delta && d.z * side > 0.0f;
        };
        const auto density = [&](const Vec3& d) { return d.z * side > 0.0f ? double(bsdf.value(wo, d).pdf) : 0.0; };
        const test::LobeTest result = test::test_lobe(sample, density, normalize(center), double(width), double(width),
                                                      kLobeSamples, 40, 16, true);
        EXPECT_GT(result.p_value, kLobeSignificance) << what << " wo.z " << wo.z;
        EXPECT_NEAR(result.integral, result.inside, 0.01) << what << " wo.z " << wo.z;
    }
};

constexpr float kCosines[] = {1.0f, 0.7f, 0.2f, 0.02f, 0.002f};

TEST_P(RoughLobes, MetalIsotropicAndNot) {
    const auto [distribution, alpha] = GetParam();
    const test::PreparedMaterial metal(
        ConductorMaterial{Rgb(0.2f), Rgb(3.0f), Rgb(1.0f), test::rough(distribution, alpha, alpha)});
    test::PreparedMaterial brushed(ConductorMaterial{Rgb(0.2f), Rgb(3.0f), Rgb(1.0f),
                                                     test::rough(distribution, alpha, std::min(1.0f, 3 * alpha))});
    for (const float cos : kCosines) {
        const Vec3 wo = at_cosine(cos, 0.7f), mirror(-wo.x, -wo.y, wo.z);
        test(metal.front(), wo, mirror, 2 * alpha, "metal");
        if (alpha == 1.0f) continue;
        ShadingPoint point;
        point.dp_du = {0.6f, 0.8f, 0.3f};
        point.dp_dv = {-0.8f, 0.6f, 0.0f};
        point.wo = wo;
        test(brushed.at(point), wo, mirror, 4 * alpha, "brushed metal");
    }
}

TEST_P(RoughLobes, GlassFromBothSides) {
    const auto [distribution, alpha] = GetParam();
    const test::PreparedMaterial glass(
        DielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), test::rough(distribution, alpha, alpha)});
    for (const bool back : {false, true})
        for (const float cos : kCosines) {
            const Vec3 wo = at_cosine(cos, -2.0f);
            const float eta = back ? 1 / 1.5f : 1.5f;
            test(*glass.side(back), wo, {-wo.x, -wo.y, wo.z}, 2 * alpha, back ? "inside, reflected" : "reflected");
            const DielectricFresnel f = fresnel_dielectric(wo.z, eta);
            if (f.reflectance < 1.0f)
                test(*glass.side(back), wo, {-wo.x / eta, -wo.y / eta, -f.cos_transmitted}, alpha,
                     back ? "inside, refracted" : "refracted");
        }
}

TEST_P(RoughLobes, Plastic) {
    const auto [distribution, alpha] = GetParam();
    const test::PreparedMaterial plastic(
        PlasticMaterial{1.5f, Rgb(0.5f), Rgb(1.0f), false, test::rough(distribution, alpha, alpha)});
    for (const float cos : kCosines) {
        const Vec3 wo = at_cosine(cos, 0.3f);
        test(plastic.front(), wo, {-wo.x, -wo.y, wo.z}, 2 * alpha, "plastic", true);
    }
}

TEST_P(RoughLobes, WardAndPhong) {
    const auto [distribution, alpha] = GetParam();
    if (distribution == Microfacets::ggx || alpha < 0.001f) return;
    test::PreparedMaterial ward(
        WardMaterial{Rgb(0.25f), Rgb(0.5f), WardVariant::balanced, test::rough(Microfacets::beckmann, alpha, alpha)});
    const test::PreparedMaterial phong(PhongMaterial{Rgb(0.25f), Rgb(0.5f), {2.0f / (alpha * alpha)}});
    for (const float cos : {1.0f, 0.7f, 0.2f}) {
        const Vec3 wo = at_cosine(cos, 0.3f), mirror(-wo.x, -wo.y, wo.z);
        test(ward.front(), wo, mirror, 2 * alpha, "Ward", true);
        test_round(phong.front(), wo, mirror, 2 * alpha, "Phong");
    }
}

TEST_P(RoughLobes, Principled) {
    const auto [distribution, alpha] = GetParam();
    if (distribution != Microfacets::ggx || alpha < 0.01f) return;
    PrincipledMaterial material;
    material.roughness = std::sqrt(alpha);
    material.metallic = 0.25f, material.clearcoat = 1.0f, material.clearcoat_gloss = 0.25f;
    const test::PreparedMaterial opaque(material);
    material.spec_trans = 0.75f;
    const test::PreparedMaterial glass(material);
    for (const float cos : {1.0f, 0.7f, 0.2f}) {
        const Vec3 wo = at_cosine(cos, 0.3f), mirror(-wo.x, -wo.y, wo.z);
        test(opaque.front(), wo, mirror, 2 * alpha, "principled", true);
        test(glass.front(), wo, mirror, 2 * alpha, "principled glass", true);
        const DielectricFresnel f = fresnel_dielectric(wo.z, 1.5f);
        test(glass.front(), wo, {-wo.x / 1.5f, -wo.y / 1.5f, -f.cos_transmitted}, alpha, "refracted");
        test(glass.back(), wo, mirror, 2 * alpha, "inside");
    }
}

TEST_P(RoughLobes, DiffuseTransmitter) {
    const auto [distribution, alpha] = GetParam();
    if (distribution != Microfacets::ggx || alpha < 0.5f) return;  // it has no roughness: once is enough
    const test::PreparedMaterial paper(DiffuseTransmitterMaterial{Rgb(0.5f)});
    for (const float cos : {1.0f, 0.7f, 0.2f})
        test_round(paper.front(), at_cosine(cos, 0.3f), Vec3(0, 0, -1), 1.0f, "passed");
}

TEST_P(RoughLobes, ThinLayer) {
    const auto [distribution, alpha] = GetParam();
    if (distribution != Microfacets::ggx || alpha < 0.5f) return;  // it has no roughness: once is enough
    for (const float g : {-0.7f, 0.0f, 0.9f}) {
        const test::PreparedMaterial layer(ThinLayerMaterial{Rgb(0.5f, 0.2f, 1.0f), Rgb(0.1f), {g}});
        for (const float cos : {1.0f, 0.7f, 0.2f}) {
            const Vec3 wo = at_cosine(cos, 0.3f), ahead = g < 0.0f ? Vec3(wo.x, wo.y, -wo.z) : -wo;
            test_round(layer.front(), wo, g < 0.0f ? wo : -ahead, 1.0f - std::abs(g), "back");
            test_round(layer.front(), wo, ahead, 1.0f - std::abs(g), "on");
        }
    }
}

TEST_P(RoughLobes, ThinPrincipled) {
    const auto [distribution, alpha] = GetParam();
    if (distribution != Microfacets::ggx || alpha < 0.01f) return;
    PrincipledThinMaterial material;
    material.roughness = std::sqrt(alpha);
    material.spec_trans = 0.75f, material.diff_trans = 0.5f;
    const test::PreparedMaterial sheet(material);
    for (const float cos : {1.0f, 0.7f, 0.2f}) {
        const Vec3 wo = at_cosine(cos, 0.3f), mirror(-wo.x, -wo.y, wo.z);
        test(sheet.front(), wo, mirror, 2 * alpha, "reflected", true);
        test_round(sheet.front(), wo, -wo, 2 * alpha, "passed");
    }
}

TEST_P(RoughLobes, Coatings) {
    const auto [distribution, alpha] = GetParam();
    if (alpha < 0.01f) return;
    const auto coated = [&](MaterialKind beneath, const Roughness& roughness) {
        Scene scene;
        CoatingMaterial coat;
        coat.eta = 1.5f;
        coat.absorption = Rgb(0.5f, 0.2f, 0.1f);
        coat.roughness = roughness;
        coat.coated = test::add_material(scene, std::move(beneath));
        test::add_material(scene, coat);
        return test::PreparedMaterial(std::move(scene));
    };
    const Roughness rough = test::rough(distribution, alpha, alpha);
    const test::PreparedMaterial paint = coated(DiffuseMaterial{Rgb(0.5f)}, rough),
                                 metal = coated(ConductorMaterial{Rgb(0.2f), Rgb(3.0f), Rgb(1.0f), rough}, {});
    for (const float cos : {1.0f, 0.7f, 0.2f}) {
        const Vec3 wo = at_cosine(cos, 0.3f), mirror(-wo.x, -wo.y, wo.z);
        test(paint.front(), wo, mirror, 2 * alpha, "rough coat", true);
        // Its smooth coat's samples are no part of the density.
        const auto smooth_only = [&](std::uint32_t i, Vec3& d) {
            const BsdfSample s = metal.front().sample(wo, uniform_numbers(i));
            d = s.wi;
            return s.pdf > 0.0f && !s.delta;
        };
        const auto density = [&](const Vec3& d) { return d.z > 0.0f ? double(metal.front().value(wo, d).pdf) : 0.0; };
        Vec3 center = mirror;
        if (center.z < std::min(0.05f, 40 * alpha)) center.z = 0.0f;
        const double width = 3.0 * double(alpha);
        const test::LobeTest result =
            test::test_lobe(smooth_only, density, normalize(center), width, width, kLobeSamples, 40, 16, true);
        EXPECT_GT(result.p_value, kLobeSignificance) << "under a smooth coat, wo.z " << wo.z;
        EXPECT_NEAR(result.integral, result.inside, 0.01) << "under a smooth coat, wo.z " << wo.z;
    }
}

INSTANTIATE_TEST_SUITE_P(Roughness, RoughLobes,
                         ::testing::Values(LobeCase{Microfacets::ggx, 0.0001f},
                                           LobeCase{Microfacets::beckmann, 0.0001f}, LobeCase{Microfacets::ggx, 0.001f},
                                           LobeCase{Microfacets::ggx, 0.01f}, LobeCase{Microfacets::ggx, 0.1f},
                                           LobeCase{Microfacets::ggx, 0.3f}, LobeCase{Microfacets::ggx, 1.0f},
                                           LobeCase{Microfacets::beckmann, 0.001f},
                                           LobeCase{Microfacets::beckmann, 0.01f},
                                           LobeCase{Microfacets::beckmann, 0.1f}, LobeCase{Microfacets::beckmann, 0.3f},
                                           LobeCase{Microfacets::beckmann, 1.0f}));

TEST(RoughLobesTest, CanFail) {
    const test::PreparedMaterial a(
        ConductorMaterial{Rgb(0.2f), Rgb(3.0f), Rgb(1.0f), test::rough(Microfacets::ggx, 0.1f, 0.1f)}),
        b(ConductorMaterial{Rgb(0.2f), Rgb(3.0f), Rgb(1.0f), test::rough(Microfacets::ggx, 0.103f, 0.103f)});
    const Vec3 wo = at_cosine(0.7f, 0.0f);
    const auto sample = [&](std::uint32_t i, Vec3& d) {
        d = a.front().sample(wo, uniform_numbers(i)).wi;
        return true;
    };
    const auto density = [&](const Vec3& d) { return double(b.front().value(wo, d).pdf); };
    EXPECT_LT(test::test_lobe(sample, density, {-wo.x, -wo.y, wo.z}, 0.2, 0.2, kLobeSamples).p_value,
              kLobeSignificance);
}

TEST(RoughLobesTest, CanFailOnABase) {
    const auto plastic = [](float alpha, float albedo) {
        return test::PreparedMaterial(
            PlasticMaterial{1.5f, Rgb(albedo), Rgb(1.0f), false, test::rough(Microfacets::beckmann, alpha, alpha)});
    };
    const Vec3 wo = at_cosine(0.2f, 0.3f);
    const auto p_value = [&](const test::PreparedMaterial& a, const test::PreparedMaterial& b) {
        const auto sample = [&](std::uint32_t i, Vec3& d) {
            const BsdfSample s = a.front().sample(wo, uniform_numbers(i));
            d = s.wi;
            return s.pdf > 0.0f && d.z > 0.0f;
        };
        const auto density = [&](const Vec3& d) { return d.z > 0.0f ? double(b.front().value(wo, d).pdf) : 0.0; };
        return test::test_lobe(sample, density, {-wo.x, -wo.y, wo.z}, 2e-4 * 0.2, 2e-4, kLobeSamples, 40, 16, true)
            .p_value;
    };
    EXPECT_GT(p_value(plastic(1e-4f, 0.5f), plastic(1e-4f, 0.5f)), kLobeSignificance);
    EXPECT_LT(p_value(plastic(1e-4f, 0.5f), plastic(1.1e-4f, 0.5f)), kLobeSignificance);
    EXPECT_LT(p_value(plastic(1e-4f, 0.5f), plastic(1e-4f, 0.6f)), kLobeSignificance) << "shares of coat and base";
}

}  // namespace
}  // namespace treefarm
