// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "worker/shading/plain_diffuse.h"

namespace treefarm {
namespace {

PlainDiffuse diffuse_bsdf(const Rgb& reflectance, bool twosided) {
    return {reflectance, twosided};
}

const Vec3 kUpwards(0, 0, 1);
const Vec3 kDown(0, 0, -1);
const Vec3 kSlanted = normalize(Vec3(1, 2, 2));
const Rgb kColour(0.2f, 0.5f, 0.8f);

TEST(Diffuse, IsReflectanceOverPi) {
    const PlainDiffuse bsdf = diffuse_bsdf(kColour, false);
    const Rgb f_cos = bsdf.value(kUpwards, kSlanted).f_cos;
    for (int k = 0; k < 3; ++k)
        EXPECT_FLOAT_EQ(f_cos[k], kColour[k] * kInvPi * kSlanted.z);
    EXPECT_FLOAT_EQ(bsdf.value(kUpwards, kSlanted).pdf, kInvPi * kSlanted.z);
}

TEST(Diffuse, OneSidedIsBlackFromBehind) {
    const PlainDiffuse bsdf = diffuse_bsdf(kColour, false);
    EXPECT_FALSE(bsdf.reflects(kDown));
    EXPECT_TRUE(is_black(bsdf.value(kDown, kDown).f_cos));
    EXPECT_TRUE(is_black(bsdf.value(kDown, kUpwards).f_cos));
    EXPECT_TRUE(is_black(bsdf.value(kUpwards, kDown).f_cos));
    EXPECT_EQ(bsdf.value(kDown, kDown).pdf, 0.0f);
    EXPECT_EQ(bsdf.sample(kDown, {0.0f, {0.3f, 0.7f}}).pdf, 0.0f);
}

TEST(Diffuse, TwosidedIsTheSameOnBothSides) {
    const PlainDiffuse bsdf = diffuse_bsdf(kColour, true);
    EXPECT_TRUE(bsdf.reflects(kDown));
    const Vec3 below(kSlanted.x, kSlanted.y, -kSlanted.z);
    EXPECT_EQ(bsdf.value(kDown, below).f_cos, bsdf.value(kUpwards, kSlanted).f_cos);
    EXPECT_TRUE(is_black(bsdf.value(kDown, kSlanted).f_cos)) << "nothing passes through";
    EXPECT_EQ(bsdf.value(kDown, kSlanted).pdf, 0.0f);
    const BsdfSample above = bsdf.sample(kUpwards, {0.0f, {0.3f, 0.6f}}),
                     under = bsdf.sample(kDown, {0.0f, {0.3f, 0.6f}});
    EXPECT_EQ(under.wi.z, -above.wi.z);
    EXPECT_EQ(under.pdf, above.pdf);
    EXPECT_EQ(under.f_cos, above.f_cos);
}

TEST(Diffuse, BlackSamplesNothing) {
    for (const PlainDiffuse& bsdf : {diffuse_bsdf(Rgb(0.0f), true), PlainDiffuse{}}) {
        EXPECT_FALSE(bsdf.reflects(kUpwards));
        EXPECT_TRUE(is_black(bsdf.value(kUpwards, kSlanted).f_cos));
        EXPECT_EQ(bsdf.sample(kUpwards, {0.0f, {0.3f, 0.6f}}).pdf, 0.0f);
    }
}

TEST(Diffuse, GrazingDirectionsAreFinite) {
    const PlainDiffuse bsdf = diffuse_bsdf(kColour, true);
    for (const float cosine : {0.0f, -0.0f, 1e-8f, -1e-8f, 1e-30f}) {
        const Vec3 grazing(1, 0, cosine);
        for (const Vec3& wo : {kUpwards, grazing}) {
            const Rgb f_cos = bsdf.value(wo, grazing).f_cos;
            EXPECT_TRUE(is_finite(f_cos));
            EXPECT_GE(f_cos.x, 0.0f);
            EXPECT_GE(bsdf.value(wo, grazing).pdf, 0.0f);
        }
        const BsdfSample s = bsdf.sample(grazing, {0.0f, {0.5f, 0.25f}});
        EXPECT_TRUE(is_finite(s.f_cos) && std::isfinite(s.pdf));
    }
}

TEST(Diffuse, RetroReflectionIsFinite) {
    const PlainDiffuse bsdf = diffuse_bsdf(kColour, false);
    EXPECT_TRUE(is_finite(bsdf.value(kSlanted, kSlanted).f_cos));
    EXPECT_GT(bsdf.value(kSlanted, kSlanted).pdf, 0.0f);
}

TEST(Diffuse, EverySampleIsUsableOrDiscarded) {
    const PlainDiffuse bsdf = diffuse_bsdf(kColour, false);
    constexpr float kLast = 0x1.fffffep-1f;
    for (const float u : {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.75f, kLast})
        for (const float v : {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.75f, kLast}) {
            const BsdfSample s = bsdf.sample(kUpwards, {0.0f, {u, v}});
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
