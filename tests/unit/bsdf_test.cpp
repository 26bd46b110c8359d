// SPDX-License-Identifier: Apache-2.0
// Values of BSDFs: energy, reciprocity, known cases, and the corners where formulas break.
#include "worker/shading/bsdf.h"

#include <gtest/gtest.h>

#include "common/base/random.h"
#include "common/scene/uses/material_traits.h"
#include "tests/support/bsdf_samples.h"
#include "tests/support/material_scenes.h"

namespace treefarm {
namespace {

using test::at_cosine;
using test::mean_power;
using test::PreparedMaterial;
using test::rough;
using test::uniform;

struct Subject {
    std::string name;
    decltype(Material::bsdf) material;
};

/// Every kind of BSDF with white parameters.
std::vector<Subject> white_materials() {
    const Rgb white(1.0f), mirror_eta(0.0f), mirror_k(1.0f);
    std::vector<Subject> all = {{"diffuse", DiffuseMaterial{white}},
                                {"mirror", ConductorMaterial{mirror_eta, mirror_k, white, {}}},
                                {"glass", DielectricMaterial{1.5f, white, white, {}}},
                                {"pane", ThinDielectricMaterial{1.5f, white, white}},
                                {"plastic", PlasticMaterial{1.5f, white, white, false, {}}},
                                {"nonlinear plastic", PlasticMaterial{1.5f, white, white, true, {}}},
                                {"null", NullMaterial{}}};
    // Oren and Nayar's model gains up to 5 % at grazing angles.
    for (const float alpha : {0.3f, 1.0f})
        for (const bool fast : {false, true})
            all.push_back({"rough diffuse", RoughDiffuseMaterial{Rgb(0.95f), {alpha}, fast}});
    for (const float exponent : {0.0f, 1.0f, 30.0f, 1e4f, 1e6f})
        all.push_back({"Phong " + std::to_string(exponent), PhongMaterial{Rgb(0.5f), Rgb(0.5f), {exponent}}});
    for (const float alpha : {1e-3f, 0.1f, 0.4f})
        all.push_back({"Ward " + std::to_string(alpha), WardMaterial{Rgb(0.5f), Rgb(0.5f), WardVariant::balanced,
                                                                     rough(Microfacets::beckmann, alpha, alpha)}});
    for (const Microfacets kind : {Microfacets::ggx, Microfacets::beckmann})
        for (const float alpha : {1e-4f, 1e-3f, 0.01f, 0.1f, 0.3f, 1.0f}) {
            const std::string name = (kind == Microfacets::ggx ? " GGX " : " Beckmann ") + std::to_string(alpha);
            all.push_back({"metal" + name, ConductorMaterial{mirror_eta, mirror_k, white, rough(kind, alpha, alpha)}});
            all.push_back({"glass" + name, DielectricMaterial{1.5f, white, white, rough(kind, alpha, alpha)}});
            all.push_back({"plastic" + name, PlasticMaterial{1.5f, white, white, true, rough(kind, alpha, alpha)}});
            all.push_back({"single return plastic" + name,
                           PlasticMaterial{1.5f, white, white, true, rough(kind, alpha, alpha), true}});
        }
    return all;
}

/// All materials, with those that may create energy, as their model does.
std::vector<Subject> all_materials() {
    std::vector<Subject> all = white_materials();
    PrincipledMaterial plain;
    plain.base_color = Rgb(1.0f);
    all.push_back({"principled", plain});
    PrincipledMaterial rich = plain;
    rich.roughness = 0.3f, rich.metallic = 0.25f, rich.spec_tint = 0.5f, rich.flatness = 0.5f;
    rich.sheen = 0.5f, rich.sheen_tint = 0.5f, rich.clearcoat = 1.0f, rich.clearcoat_gloss = 0.5f;
    all.push_back({"rich principled", rich});
    PrincipledMaterial glass = rich;
    glass.spec_trans = 0.75f;
    all.push_back({"principled glass", glass});
    PrincipledThinMaterial thin;
    thin.base_color = Rgb(1.0f), thin.roughness = 0.4f, thin.spec_tint = 0.5f;
    thin.sheen = 0.5f, thin.sheen_tint = 0.5f, thin.flatness = 0.5f;
    all.push_back({"thin principled", thin});
    thin.spec_trans = 0.5f, thin.diff_trans = 1.2f;
    all.push_back({"thin principled that transmits", thin});
    all.push_back({"diffuse transmitter", DiffuseTransmitterMaterial{Rgb(1.0f)}});
    for (const float depth : {0.0f, 1e-6f, 0.5f, 100.0f, 1e30f})
        for (const float g : {-0.9f, 0.0f, 0.99f}) {
            const std::string name = "layer " + std::to_string(depth) + " g " + std::to_string(g);
            all.push_back({name, ThinLayerMaterial{Rgb(depth), Rgb(0.0f), {g}}});
            all.push_back({"opaque " + name, ThinLayerMaterial{Rgb(depth), Rgb(0.0f), {g}}.opaque()});
        }
    for (const WardVariant variant : {WardVariant::ward, WardVariant::duer})
        all.push_back(
            {"older Ward", WardMaterial{Rgb(0.5f), Rgb(0.5f), variant, rough(Microfacets::beckmann, 0.1f, 0.1f)}});
    return all;
}

TEST(Bsdf, NoneCreatesEnergyAtAnyAngle) {
    for (const Subject& subject : white_materials()) {
        const PreparedMaterial prepared(subject.material);
        for (const bool back : {false, true}) {
            const Bsdf* bsdf = prepared.side(back);
            if (!bsdf) continue;
            for (const float cos : {1.0f, 0.6f, 0.1f, 1e-3f, 1e-8f}) {
                const double power = mean_power(*bsdf, at_cosine(cos, 1.0f), 4000);
                EXPECT_LT(power, 1.03) << subject.name << (back ? " back " : " front ") << cos;
                EXPECT_GE(power, 0.0);
            }
        }
    }
}

TEST(Bsdf, SmoothBoundariesKeepAllEnergy) {
    for (const decltype(Material::bsdf)& material :
         {decltype(Material::bsdf)(DielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), {}}),
          decltype(Material::bsdf)(DielectricMaterial{0.7f, Rgb(1.0f), Rgb(1.0f), {}}),
          decltype(Material::bsdf)(ThinDielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f)}),
          decltype(Material::bsdf)(DielectricMaterial{1.0f, Rgb(1.0f), Rgb(1.0f), {}}),
          decltype(Material::bsdf)(ConductorMaterial{Rgb(0.0f), Rgb(1.0f), Rgb(1.0f), {}})}) {
        const PreparedMaterial prepared(material);
        for (const bool back : {false, true})
            if (const Bsdf* bsdf = prepared.side(back)) {
                for (const float cos : {1.0f, 0.75f, 0.3f, 1e-4f})
                    EXPECT_NEAR(mean_power(*bsdf, at_cosine(cos, 0.4f), 100), 1.0, 2e-6) << cos << back;
            }
    }
}

TEST(Bsdf, RoughMetalOfSmallRoughnessIsAMirror) {
    const ConductorMaterial metal{Rgb(0.2f, 0.9f, 1.1f), Rgb(3.9f, 2.5f, 2.4f), Rgb(1.0f), {}};
    const PreparedMaterial mirror(metal);
    for (const Microfacets kind : {Microfacets::ggx, Microfacets::beckmann}) {
        ConductorMaterial nearly = metal;
        nearly.roughness = rough(kind, 1e-4f, 1e-4f);
        const PreparedMaterial prepared(nearly);
        for (const float cos : {1.0f, 0.5f, 0.05f}) {
            const Vec3 wo = at_cosine(cos, 2.0f);
            const BsdfSample exact = mirror.front().sample(wo, uniform(0));
            for (std::uint32_t i = 0; i < 2000; ++i) {
                const BsdfSample s = prepared.front().sample(wo, uniform(i));
                ASSERT_GT(s.pdf, 0.0f);
                ASSERT_NEAR(s.f_cos.x / s.pdf, exact.f_cos.x, 2e-2f);
                ASSERT_LT((s.wi - exact.wi).length(), 0.3f);  // GGX has long tails
            }
        }
    }
}

TEST(Bsdf, SamplesCarryTheirValueAndDensity) {
    for (const Subject& subject : all_materials()) {
        const PreparedMaterial prepared(subject.material);
        for (const bool back : {false, true}) {
            const Bsdf* bsdf = prepared.side(back);
            if (!bsdf) continue;
            const Vec3 wo = at_cosine(0.4f, -1.0f);
            for (std::uint32_t i = 0; i < 200; ++i) {
                const BsdfSample s = bsdf->sample(wo, uniform(i));
                if (s.delta || !(s.pdf > 0.0f)) continue;
                const BsdfValue v = bsdf->value(wo, s.wi);
                ASSERT_EQ(v.pdf, s.pdf) << subject.name;
                ASSERT_EQ(v.f_cos, s.f_cos) << subject.name;
            }
        }
    }
}

TEST(Bsdf, IsReciprocal) {
    for (const Subject& subject : all_materials()) {
        const PreparedMaterial prepared(subject.material);
        for (std::uint32_t i = 0; i < 300; ++i) {
            const Draw r = draw({17, i, 0}, 0, Stream::scatter);
            const Vec3 a = at_cosine(0.05f + 0.9f * to_unit(r[0]), 6.28f * to_unit(r[1]));
            const Vec3 b = at_cosine(0.05f + 0.9f * to_unit(r[2]), 6.28f * to_unit(r[3]));
            const float forward = prepared.front().value(a, b).f_cos.x / b.z,
                        backward = prepared.front().value(b, a).f_cos.x / a.z;
            ASSERT_NEAR(forward, backward, 1e-4f * (1.0f + std::abs(forward))) << subject.name;
            if (refraction_of(prepared.front()) == 1.0f) continue;
            // From the far side, in its own mirrored frame: f / eta^2 is the same both ways.
            const Vec3 below(b.x, b.y, -b.z), above(a.x, a.y, -a.z);
            const float in = prepared.front().value(a, below).f_cos.x / b.z,
                        out = prepared.back().value({b.x, b.y, b.z}, above).f_cos.x / a.z;
            ASSERT_NEAR(in * 1.5f * 1.5f, out, 2e-3f * (1e-3f + std::abs(out))) << subject.name;
        }
    }
}

TEST(Bsdf, GrazingAndOppositeDirectionsAreFinite) {
    for (const Subject& subject : all_materials()) {
        const PreparedMaterial prepared(subject.material);
        for (const bool back : {false, true}) {
            const Bsdf* bsdf = prepared.side(back);
            if (!bsdf) continue;
            for (const float cos_o : {1.0f, 0.5f, 1e-4f, 1e-8f, 1e-30f})
                for (const float cos_i : {1.0f, 1e-4f, 1e-8f, 1e-30f, 0.0f, -0.0f, -1e-30f, -1e-8f, -1e-4f, -1.0f})
                    for (const float azimuth : {0.0f, 3.14159265f, 1.0f}) {
                        const BsdfValue v = bsdf->value(at_cosine(cos_o, 0.0f), at_cosine(cos_i, azimuth));
                        ASSERT_TRUE(is_finite(v.f_cos) && v.f_cos.x >= 0.0f) << subject.name << cos_o << " " << cos_i;
                        ASSERT_TRUE(std::isfinite(v.pdf) && v.pdf >= 0.0f) << subject.name << cos_o << " " << cos_i;
                    }
            // The ends of the range of random numbers.
            for (const float u : {0.0f, 0x1p-24f, 0.5f, 0x1.fffffep-1f})
                for (const float v : {0.0f, 0.5f, 0x1.fffffep-1f})
                    for (const float cos_o : {1.0f, 1e-4f, 1e-30f}) {
                        const BsdfSample s = bsdf->sample(at_cosine(cos_o, 0.0f), {u, {u, v}});
                        ASSERT_TRUE(is_finite(s.wi) && is_finite(s.f_cos) && std::isfinite(s.pdf)) << subject.name;
                    }
        }
    }
}

TEST(Bsdf, OpaqueIsBlackBehindUnlessTwosided) {
    for (const Subject& subject : white_materials()) {
        const PreparedMaterial prepared(subject.material);
        const bool transmits = std::holds_alternative<DielectricMaterial>(subject.material) ||
                               std::holds_alternative<ThinDielectricMaterial>(subject.material) ||
                               std::holds_alternative<NullMaterial>(subject.material);
        EXPECT_EQ(prepared.side(true) != nullptr, transmits) << subject.name;
        if (!transmits) {
            const PreparedMaterial both(subject.material, true);
            EXPECT_NE(both.side(true), nullptr);
        }
    }
}

TEST(Bsdf, TwosidedCanHaveAnotherBack) {
    Scene scene;
    const std::int32_t red = test::add_diffuse(scene, Rgb(1.0f, 0.0f, 0.0f));
    Material material;
    material.bsdf = DiffuseMaterial{Rgb(0.0f, 1.0f, 0.0f)};
    material.twosided = true;
    material.back = red;
    scene.materials.push_back(material);
    const PreparedMaterial prepared(scene);
    const Vec3 up(0, 0, 1);
    EXPECT_EQ(prepared.front().value(up, up).f_cos.x, 0.0f);
    EXPECT_GT(prepared.back().value(up, up).f_cos.x, 0.0f);
    EXPECT_EQ(prepared.back().value(up, up).f_cos.y, 0.0f);
}

TEST(Bsdf, BlendsInterpolateAndSampleBoth) {
    Scene scene;
    const std::int32_t diffuse = test::add_diffuse(scene, Rgb(0.8f));
    const std::int32_t glass = test::add_material(scene, DielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), {}});
    test::add_material(scene, BlendMaterial{FloatInput(0.25f), diffuse, glass});
    const PreparedMaterial prepared(scene);
    const Vec3 up(0, 0, 1);
    EXPECT_NEAR(prepared.front().value(up, up).f_cos.x, 0.75f * 0.8f * kInvPi, 1e-6f);
    EXPECT_EQ(lobes_of(prepared.front()), kSmoothLobe | kWideLobe | kDeltaLobe | kTransmittingLobe);
    EXPECT_EQ(lobes_of(prepared.back()), kDeltaLobe | kTransmittingLobe) << "diffuse reflects on its front only";
    EXPECT_NEAR(mean_power(prepared.front(), up, 40000), 0.75 * 0.8 + 0.25, 0.01);
    EXPECT_NEAR(mean_power(prepared.back(), up, 40000), 0.25, 0.01);
}

TEST(Bsdf, LobesAreThoseThatThePlanExpects) {
    for (const Subject& subject : white_materials()) {
        Scene scene;
        const std::int32_t material = test::add_material(scene, subject.material);
        const Lobes expected = material_traits(scene, material).lobes;
        const PreparedMaterial prepared(scene);
        const LobeBits lobes = lobes_of(prepared.front());
        EXPECT_EQ((lobes & kSmoothLobe) != 0, expected.smooth()) << subject.name;
        EXPECT_EQ((lobes & kDeltaLobe) != 0, expected.delta()) << subject.name;
        EXPECT_EQ(prepared.side(true) != nullptr, expected.transmits()) << subject.name;
        EXPECT_EQ(prepared.varies(), material_traits(scene, material).needs_surface_detail()) << subject.name;
        for (std::uint32_t i = 0; i < 500 && (lobes & kWideLobe); ++i) {
            const Vec3 wi = square_to_cosine_hemisphere(uniform(i).point);
            EXPECT_FALSE(is_black(prepared.front().value(at_cosine(0.7f, 0.0f), wi).f_cos)) << subject.name;
        }
        bool below = false, delta = false, smooth = false;
        for (std::uint32_t i = 0; i < 500; ++i) {
            const BsdfSample s = prepared.front().sample(at_cosine(0.7f, 0.0f), uniform(i));
            if (!(s.pdf > 0.0f)) continue;
            below |= s.wi.z < 0.0f;
            (s.delta ? delta : smooth) = true;
        }
        EXPECT_EQ(below, expected.transmits()) << subject.name;
        EXPECT_EQ(delta, expected.delta()) << subject.name;
        EXPECT_EQ(smooth, expected.smooth()) << subject.name;
    }
}

TEST(Bsdf, EndlessBlendsAreRefused) {
    Scene scene;
    std::int32_t last = test::add_diffuse(scene, Rgb(0.5f));
    for (int i = 0; i < 40; ++i)
        last = test::add_material(scene, BlendMaterial{FloatInput(0.5f), last, last});
    EXPECT_THROW(PreparedMaterial{scene}, RunError);
}

}  // namespace
}  // namespace treefarm
