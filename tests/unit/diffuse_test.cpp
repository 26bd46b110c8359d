#include <gtest/gtest.h>

#include "worker/shading/bsdf.h"

namespace treefarm {
namespace {

Bsdf diffuse_bsdf(const Rgb& reflectance, bool twosided) {
    Scene scene;
    Material material;
    material.bsdf = DiffuseMaterial{reflectance};
    material.twosided = twosided;
    scene.materials.push_back(material);
    return make_bsdf(scene, 0);
}

const Vec3 kUp(0, 0, 1);
const Vec3 kDown(0, 0, -1);
const Vec3 kSlanted = normalize(Vec3(1, 2, 2));
const Rgb kColour(0.2f, 0.5f, 0.8f);

TEST(Diffuse, IsReflectanceOverPi) {
    const Bsdf bsdf = diffuse_bsdf(kColour, false);
    const Rgb f_cos = bsdf_eval(bsdf, kUp, kSlanted);
    for (int k = 0; k < 3; ++k)
        EXPECT_FLOAT_EQ(f_cos[k], kColour[k] * kInvPi * kSlanted.z);
    EXPECT_FLOAT_EQ(bsdf_pdf(bsdf, kUp, kSlanted), kInvPi * kSlanted.z);
}

TEST(Diffuse, OneSidedIsBlackFromBehind) {
    const Bsdf bsdf = diffuse_bsdf(kColour, false);
    EXPECT_FALSE(bsdf_reflects(bsdf, kDown));
    EXPECT_TRUE(is_black(bsdf_eval(bsdf, kDown, kDown)));
    EXPECT_TRUE(is_black(bsdf_eval(bsdf, kDown, kUp)));
    EXPECT_TRUE(is_black(bsdf_eval(bsdf, kUp, kDown)));
    EXPECT_EQ(bsdf_pdf(bsdf, kDown, kDown), 0.0f);
    EXPECT_EQ(bsdf_sample(bsdf, kDown, {0.3f, 0.7f}).pdf, 0.0f);
}

TEST(Diffuse, TwosidedIsTheSameOnBothSides) {
    const Bsdf bsdf = diffuse_bsdf(kColour, true);
    EXPECT_TRUE(bsdf_reflects(bsdf, kDown));
    const Vec3 below(kSlanted.x, kSlanted.y, -kSlanted.z);
    EXPECT_EQ(bsdf_eval(bsdf, kDown, below), bsdf_eval(bsdf, kUp, kSlanted));
    EXPECT_TRUE(is_black(bsdf_eval(bsdf, kDown, kSlanted))) << "nothing passes through";
    EXPECT_EQ(bsdf_pdf(bsdf, kDown, kSlanted), 0.0f);
    const BsdfSample above = bsdf_sample(bsdf, kUp, {0.3f, 0.6f}), under = bsdf_sample(bsdf, kDown, {0.3f, 0.6f});
    EXPECT_EQ(under.wi.z, -above.wi.z);
    EXPECT_EQ(under.pdf, above.pdf);
    EXPECT_EQ(under.f_cos, above.f_cos);
}

TEST(Diffuse, BlackSamplesNothing) {
    for (const Bsdf& bsdf : {diffuse_bsdf(Rgb(0.0f), true), make_bsdf(Scene{}, kNone)}) {
        EXPECT_FALSE(bsdf_reflects(bsdf, kUp));
        EXPECT_TRUE(is_black(bsdf_eval(bsdf, kUp, kSlanted)));
        EXPECT_EQ(bsdf_pdf(bsdf, kUp, kSlanted), 0.0f);
        EXPECT_EQ(bsdf_sample(bsdf, kUp, {0.3f, 0.6f}).pdf, 0.0f);
    }
}

TEST(Diffuse, GrazingDirectionsAreFinite) {
    const Bsdf bsdf = diffuse_bsdf(kColour, true);
    for (const float cosine : {0.0f, -0.0f, 1e-8f, -1e-8f, 1e-30f}) {
        const Vec3 grazing(1, 0, cosine);
        for (const Vec3& wo : {kUp, grazing}) {
            const Rgb f_cos = bsdf_eval(bsdf, wo, grazing);
            EXPECT_TRUE(is_finite(f_cos));
            EXPECT_GE(f_cos.x, 0.0f);
            EXPECT_GE(bsdf_pdf(bsdf, wo, grazing), 0.0f);
        }
        const BsdfSample s = bsdf_sample(bsdf, grazing, {0.5f, 0.25f});
        EXPECT_TRUE(is_finite(s.f_cos) && std::isfinite(s.pdf));
    }
}

TEST(Diffuse, RetroReflectionIsFinite) {
    const Bsdf bsdf = diffuse_bsdf(kColour, false);
    EXPECT_TRUE(is_finite(bsdf_eval(bsdf, kSlanted, kSlanted)));
    EXPECT_GT(bsdf_pdf(bsdf, kSlanted, kSlanted), 0.0f);
}

TEST(Diffuse, EverySampleIsUsableOrDiscarded) {
    const Bsdf bsdf = diffuse_bsdf(kColour, false);
    constexpr float kLast = 0x1.fffffep-1f;
    for (const float u : {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.75f, kLast})
        for (const float v : {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.75f, kLast}) {
            const BsdfSample s = bsdf_sample(bsdf, kUp, {u, v});
            ASSERT_TRUE(is_finite(s.wi) && is_finite(s.f_cos) && std::isfinite(s.pdf)) << u << " " << v;
            ASSERT_NEAR(s.wi.length(), 1.0f, 1e-6f);
            ASSERT_GE(s.wi.z, 0.0f);
            if (s.pdf > 0.0f) {
                for (int k = 0; k < 3; ++k)
                    ASSERT_NEAR(s.f_cos[k] / s.pdf, kColour[k], 1e-5f) << u << " " << v;
            }
        }
}

}  // namespace
}  // namespace treefarm
