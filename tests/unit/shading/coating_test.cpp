// SPDX-License-Identifier: Apache-2.0
// Coats over other materials: known cases, energy, reciprocity, both sides.
#include "worker/shading/coating.h"

#include <gtest/gtest.h>

#include "tests/support/bsdf_samples.h"
#include "tests/support/material_scenes.h"

namespace treefarm {
namespace {

using test::add_material;
using test::at_cosine;
using test::mean_power;
using test::PreparedMaterial;
using test::rough;

/// A coat over another material.
PreparedMaterial coated(MaterialKind beneath, CoatingMaterial coat, bool beneath_twosided = false) {
    Scene scene;
    coat.coated = add_material(scene, std::move(beneath), beneath_twosided);
    add_material(scene, coat);
    return PreparedMaterial(std::move(scene));
}

CoatingMaterial coat_of(float eta, float absorption = 0.0f, const Roughness& roughness = {}) {
    CoatingMaterial coat;
    coat.eta = eta;
    coat.absorption = Rgb(absorption);
    coat.roughness = roughness;
    return coat;
}

/// Materials that keep all energy, or nearly.
std::vector<std::pair<const char*, MaterialKind>> white_beneath() {
    const Rgb white(1.0f);
    return {{"diffuse", DiffuseMaterial{white}},
            {"mirror", ConductorMaterial{Rgb(0.0f), white, white, {}}},
            {"rough metal", ConductorMaterial{Rgb(0.0f), white, white, rough(Microfacets::ggx, 0.3f, 0.3f)}},
            {"plastic", PlasticMaterial{1.5f, white, white, false, {}}}};
}

std::vector<CoatingMaterial> coats() {
    return {coat_of(1.5f),
            coat_of(1.5f, 0.2f),
            coat_of(0.7f),
            coat_of(1.0f),
            coat_of(1.5f, 0.0f, rough(Microfacets::beckmann, 0.01f, 0.01f)),
            coat_of(1.5f, 0.1f, rough(Microfacets::ggx, 0.3f, 0.3f)),
            coat_of(0.7f, 0.1f, rough(Microfacets::ggx, 0.1f, 0.1f))};
}

TEST(Coating, OfTheOutsidesIndexIsNotThere) {
    for (const auto& [name, beneath] : white_beneath()) {
        const PreparedMaterial bare(beneath), under = coated(beneath, coat_of(1.0f));
        for (std::uint32_t i = 0; i < 200; ++i) {
            const Draw r = draw({29, i, 0}, 0, Stream::scatter);
            const Vec3 wo = at_cosine(0.05f + 0.9f * to_unit(r[0]), 6.28f * to_unit(r[1]));
            const Vec3 wi = at_cosine(0.05f + 0.9f * to_unit(r[2]), 6.28f * to_unit(r[3]));
            const BsdfValue a = bare.front().value(wo, wi), b = under.front().value(wo, wi);
            ASSERT_NEAR(a.f_cos.x, b.f_cos.x, 2e-4f * (1.0f + a.f_cos.x)) << name;
            ASSERT_NEAR(a.pdf, b.pdf, 2e-4f * (1.0f + a.pdf)) << name;
        }
    }
}

TEST(Coating, CreatesNoEnergyAndIsReciprocal) {
    for (const auto& [name, beneath] : white_beneath())
        for (const CoatingMaterial& coat : coats()) {
            const PreparedMaterial prepared = coated(beneath, coat);
            for (const float cos : {1.0f, 0.6f, 0.1f, 1e-3f})
                EXPECT_LT(mean_power(prepared.front(), at_cosine(cos, 1.0f), 4000), 1.03) << name << coat.eta << cos;
            for (std::uint32_t i = 0; i < 200; ++i) {
                const Draw r = draw({31, i, 0}, 0, Stream::scatter);
                const Vec3 a = at_cosine(0.05f + 0.9f * to_unit(r[0]), 6.28f * to_unit(r[1]));
                const Vec3 b = at_cosine(0.05f + 0.9f * to_unit(r[2]), 6.28f * to_unit(r[3]));
                const float forward = prepared.front().value(a, b).f_cos.x / b.z,
                            backward = prepared.front().value(b, a).f_cos.x / a.z;
                ASSERT_NEAR(forward, backward, 5e-4f * (1.0f + std::abs(forward))) << name << coat.eta;
            }
        }
}

/// F + a T(wo) T_d / eta^2 with the diffuse transmittance T_d of a smooth boundary.
TEST(Coating, AlbedoOverDiffuseIsThatOfTheFormula) {
    const float eta = 1.5f;
    const PreparedMaterial prepared = coated(DiffuseMaterial{Rgb(0.8f)}, coat_of(eta));
    for (const float cos : {1.0f, 0.5f, 0.2f}) {
        const double mirrored = double(fresnel_dielectric(cos, eta).reflectance);
        const double expected =
            mirrored + 0.8 * (1 - mirrored) * double(smooth_diffuse_transmittance(eta)) / double(eta * eta);
        const Vec3 wo = at_cosine(cos, 2.0f);
        EXPECT_NEAR(mean_power(prepared.front(), wo, 400000), expected, 2e-3) << cos;
        // By directions that do not come from the BSDF; all of the density is within the cone that leaves the coat.
        double value = 0, density = 0;
        constexpr int kDirections = 100000;
        for (std::uint32_t i = 0; i < kDirections; ++i) {
            const Draw r = draw({41, i, 0}, 0, Stream::scatter);
            const Vec3 wi = square_to_cosine_hemisphere({to_unit(r[0]), to_unit(r[1])});
            const BsdfValue v = prepared.front().value(wo, wi);
            value += double(v.f_cos.x) / double(cosine_hemisphere_pdf(wi.z)) / kDirections;
            density += double(v.pdf) / double(cosine_hemisphere_pdf(wi.z)) / kDirections;
        }
        EXPECT_NEAR(value, expected - mirrored, 3e-3) << cos;
        const double mirror = double(coat_probability(float(mirrored), 0.5f));
        EXPECT_NEAR(density, (1 - mirror) / double(eta * eta), 3e-3) << cos;
    }
}

TEST(Coating, AMirrorBeneathIsSeenThroughBoundaryAndColour) {
    const float eta = 1.5f, depth = 0.3f;
    const PreparedMaterial prepared =
        coated(ConductorMaterial{Rgb(0.0f), Rgb(1.0f), Rgb(1.0f), {}}, coat_of(eta, depth));
    const Vec3 wo = at_cosine(0.4f, 0.3f);
    const DielectricFresnel f = fresnel_dielectric(wo.z, eta);
    const float passes = (1.0f - f.reflectance) * (1.0f - f.reflectance) * std::exp(-2.0f * depth / f.cos_transmitted);
    double coat = 0, mirror = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const Draw r = draw({37, i, 0}, 0, Stream::scatter);
        const BsdfSample s = prepared.front().sample(wo, {to_unit(r[1]), {to_unit(r[2]), to_unit(r[3])}});
        ASSERT_TRUE(s.delta);
        ASSERT_NEAR((s.wi - Vec3(-wo.x, -wo.y, wo.z)).length(), 0.0f, 1e-5f);
        const bool of_coat = std::abs(s.f_cos.x - f.reflectance) < 1e-5f;
        ASSERT_NEAR(s.f_cos.x, of_coat ? f.reflectance : passes, 1e-5f);
        (of_coat ? coat : mirror) = double(s.pdf);
    }
    EXPECT_NEAR(coat + mirror, 1.0, 1e-6) << "probabilities of the two";
}

/// A coat of facets that hardly tilt looks like a smooth one, but for its mirror image, which has a density.
TEST(Coating, OfLittleRoughnessIsNearlySmooth) {
    const PreparedMaterial smooth = coated(DiffuseMaterial{Rgb(0.8f)}, coat_of(1.5f, 0.1f)),
                           nearly = coated(DiffuseMaterial{Rgb(0.8f)},
                                           coat_of(1.5f, 0.1f, rough(Microfacets::beckmann, 0.002f, 0.002f)));
    for (const float cos : {0.95f, 0.5f, 0.2f}) {
        const Vec3 wo = at_cosine(cos, 0.0f), wi = at_cosine(0.6f, 1.0f);
        const float expected = smooth.front().value(wo, wi).f_cos.x;
        EXPECT_NEAR(nearly.front().value(wo, wi).f_cos.x, expected, 5e-3f * expected) << cos;
        EXPECT_NEAR(mean_power(nearly.front(), wo, 100000), mean_power(smooth.front(), wo, 100000), 6e-3) << cos;
    }
}

TEST(Coating, IsOnBothSidesOfWhatItCoats) {
    const Vec3 wo = at_cosine(0.5f, 0.0f), wi = at_cosine(0.7f, 1.0f);
    const PreparedMaterial one = coated(DiffuseMaterial{Rgb(0.8f)}, coat_of(1.5f)),
                           two = coated(DiffuseMaterial{Rgb(0.8f)}, coat_of(1.5f), true);
    EXPECT_GT(one.front().value(wo, wi).f_cos.x, 0.0f);
    EXPECT_EQ(one.back().value(wo, wi).f_cos.x, 0.0f) << "black beneath";
    EXPECT_EQ(lobes_of(one.back()), kDeltaLobe);
    EXPECT_EQ(two.back().value(wo, wi).f_cos, two.front().value(wo, wi).f_cos);
}

TEST(Coating, MayBeTexturedOverAMaterialWithBumps) {
    Scene scene;
    CoatingMaterial coat = coat_of(1.5f, 0.0f, rough(Microfacets::ggx, 0.2f, 0.2f));
    coat.coated = add_material(scene, DiffuseMaterial{Rgb(0.8f)});
    scene.materials[0].detail.normal_map = test::add_image_texture(scene, 1, 1, {0.8f, 0.5f, 0.9f});
    coat.specular_reflectance = Rgb(0.0f);
    coat.absorption = {Rgb(1.0f), test::add_board(scene, Rgb(0.0f), Rgb(2.0f))};
    coat.roughness.alpha_u = coat.roughness.alpha_v = {1.0f, test::add_board(scene, Rgb(0.1f), Rgb(0.3f))};
    add_material(scene, coat);
    PreparedMaterial prepared(std::move(scene));
    ASSERT_TRUE(prepared.varies() && prepared.needs_tangents());
    ShadingPoint point;
    point.wo = at_cosine(0.7f, 0.0f);
    const Vec3 towards = at_cosine(0.7f, 0.1f), away = at_cosine(0.7f, 3.1f);
    point.uv = Vec2(0.25f, 0.25f);
    const Rgb clear = prepared.at(point).value(point.wo, towards).f_cos;
    // The map tilts the base along +u: what comes from there is brighter.
    EXPECT_GT(clear.x, 1.2f * prepared.at(point).value(point.wo, away).f_cos.x);
    point.uv = Vec2(0.75f, 0.25f);
    EXPECT_LT(prepared.at(point).value(point.wo, towards).f_cos.x, 0.2f * clear.x) << "optical depth 2";
}

}  // namespace
}  // namespace treefarm
