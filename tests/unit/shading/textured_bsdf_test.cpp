// SPDX-License-Identifier: Apache-2.0
// Materials that vary over a surface: textures, bump and normal maps, tangents.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/base/random.h"
#include "common/math/warp.h"
#include "tests/support/material_scenes.h"

namespace treefarm {
namespace {

using test::PreparedMaterial;

const Vec3 kUp(0, 0, 1);

ShadingPoint point_at(float u, float v, const Vec3& wo = kUp, bool mirrored = false) {
    ShadingPoint point;
    point.uv = {u, v};
    point.wo = wo;
    point.mirrored = mirrored;
    return point;
}

TEST(Textured, ReflectanceIsLookedUp) {
    Scene scene;
    const std::int32_t board = test::add_board(scene, Rgb(0.8f, 0.4f, 0.2f), Rgb(0.1f));
    test::add_material(scene, DiffuseMaterial{ColorInput(Rgb(1.0f, 1.0f, 0.5f), board)});
    PreparedMaterial prepared(scene);
    ASSERT_TRUE(prepared.varies());
    EXPECT_EQ(prepared.at(point_at(0.1f, 0.1f)).value(kUp, kUp).f_cos, Rgb(0.8f, 0.4f, 0.1f) * kInvPi);
    EXPECT_EQ(prepared.at(point_at(0.6f, 0.1f)).value(kUp, kUp).f_cos, Rgb(0.1f, 0.1f, 0.05f) * kInvPi);
}

/// A texture that reaches 2: Mitsuba 2 and 3 keep it, elsewhere what the reader has not scaled down counts as 1.
TEST(Textured, UnlimitedMaterialsKeepFactorsAbove1) {
    Scene scene;
    const std::int32_t board = test::add_board(scene, Rgb(2.0f, 0.4f, 1.5f), Rgb(0.1f));
    const std::int32_t material = test::add_material(scene, DiffuseMaterial{ColorInput(Rgb(1.0f), board)});
    EXPECT_EQ(PreparedMaterial(scene).at(point_at(0.1f, 0.1f)).value(kUp, kUp).f_cos, Rgb(1.0f, 0.4f, 1.0f) * kInvPi);
    scene.materials[static_cast<std::size_t>(material)].unlimited = true;
    EXPECT_EQ(PreparedMaterial(scene).at(point_at(0.1f, 0.1f)).value(kUp, kUp).f_cos, Rgb(2.0f, 0.4f, 1.5f) * kInvPi);
    PlasticMaterial plastic;
    plastic.diffuse_reflectance = ColorInput(Rgb(1.0f), board);
    plastic.nonlinear = true;
    scene.materials[static_cast<std::size_t>(material)].bsdf = plastic;
    const Rgb nonlinear = PreparedMaterial(scene).at(point_at(0.1f, 0.1f)).value(kUp, kUp).f_cos;
    EXPECT_GT(std::min({nonlinear.x, nonlinear.y, nonlinear.z}), 0.0f) << "1 / (1 - 2 fdr) would be negative";
}

/// Principled parts keep their inputs beside their nodes: a blend of two is their mean.
TEST(Textured, PrincipledPartsOfABlendAreKeptApart) {
    const auto value = [](bool first, bool second) {
        Scene scene;
        std::int32_t parts[2];
        for (const int k : {0, 1}) {
            PrincipledMaterial part;
            part.base_color = ColorInput(Rgb(1.0f), test::add_board(scene, Rgb(k == 0 ? 0.8f : 0.2f), Rgb(0.1f)));
            part.roughness = k == 0 ? 0.3f : 0.9f;
            parts[k] = test::add_material(scene, part);
        }
        test::add_material(scene, BlendMaterial{{0.5f}, parts[first ? 0 : 1], parts[second ? 1 : 0]});
        return PreparedMaterial(scene).at(point_at(0.1f, 0.1f)).value(kUp, kUp).f_cos.x;
    };
    EXPECT_NE(value(true, false), value(false, true));
    EXPECT_FLOAT_EQ(value(true, true), 0.5f * (value(true, false) + value(false, true)));
}

TEST(Textured, BackOfAnOpaqueSurfaceIsBlackWhateverWasBuiltBefore) {
    Scene scene;
    const std::int32_t board = test::add_board(scene, Rgb(0.8f), Rgb(0.1f));
    test::add_material(scene, DiffuseMaterial{ColorInput(Rgb(1.0f), board)});
    PreparedMaterial prepared(scene);
    EXPECT_GT(prepared.at(point_at(0.1f, 0.1f)).value(kUp, kUp).f_cos.x, 0.0f);
    EXPECT_EQ(prepared.at(point_at(0.1f, 0.1f), true).value(kUp, kUp).f_cos, Rgb(0.0f));
}

TEST(Textured, BlendWeightIsLookedUp) {
    Scene scene;
    const std::int32_t board = test::add_board(scene, Rgb(0.0f), Rgb(1.0f));
    const std::int32_t black = test::add_diffuse(scene, Rgb(0.0f)), white = test::add_diffuse(scene, Rgb(1.0f));
    test::add_material(scene, BlendMaterial{FloatInput(1.0f, board), black, white});
    PreparedMaterial prepared(scene);
    EXPECT_EQ(prepared.at(point_at(0.1f, 0.1f)).value(kUp, kUp).f_cos.x, 0.0f);
    EXPECT_NEAR(prepared.at(point_at(0.6f, 0.1f)).value(kUp, kUp).f_cos.x, kInvPi, 1e-6f);
}

/// Diffuse with a bump whose height rises by `slope` per unit of u (within a large image).
Scene bumped(float slope, bool twosided = false) {
    Scene scene;
    std::vector<float> heights;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 64; ++x)
            heights.insert(heights.end(), 3, slope * (float(x) + 0.5f) / 64);
    const std::int32_t height = test::add_image_texture(scene, 64, 8, heights);
    const std::int32_t material = test::add_material(scene, DiffuseMaterial{Rgb(1.0f)}, twosided);
    scene.materials[static_cast<std::size_t>(material)].detail.bump = height;
    return scene;
}

TEST(Bump, TiltsTheNormalByTheSlope) {
    PreparedMaterial prepared(bumped(0.5f));
    const Vec3 expected = normalize(Vec3(-0.5f, 0.0f, 1.0f));
    const Bsdf& bsdf = prepared.at(point_at(0.5f, 0.5f));
    const auto* frame = std::get_if<OrientedBsdf>(&bsdf.kind);
    ASSERT_NE(frame, nullptr);
    EXPECT_LT((frame->n - expected).length(), 1e-4f);
    EXPECT_NEAR(dot(frame->s, frame->n), 0.0f, 1e-6f);
    EXPECT_NEAR(dot(frame->s, frame->t), 0.0f, 1e-6f);
    const Vec3 wi = normalize(Vec3(0.3f, 0.2f, 0.8f));
    EXPECT_NEAR(bsdf.value(kUp, wi).f_cos.x, dot(wi, expected) * kInvPi, 1e-4f);
}

TEST(Bump, TangentsAreAskedForWhereAPartNeedsThem) {
    Scene plain;
    const std::int32_t board = test::add_board(plain, Rgb(0.8f), Rgb(0.1f));
    const std::int32_t textured = test::add_material(plain, DiffuseMaterial{ColorInput(Rgb(1.0f), board)});
    EXPECT_FALSE(PreparedMaterial(plain).needs_tangents());
    EXPECT_TRUE(PreparedMaterial(bumped(0.5f)).needs_tangents());

    Scene blend = bumped(0.5f);
    const std::int32_t bump = static_cast<std::int32_t>(blend.materials.size()) - 1;
    const std::int32_t inner =
        test::add_material(blend, BlendMaterial{FloatInput(0.5f), test::add_diffuse(blend, Rgb(0.5f)), bump});
    test::add_material(blend, BlendMaterial{FloatInput(0.5f), inner, test::add_diffuse(blend, Rgb(0.2f))});
    EXPECT_TRUE(PreparedMaterial(blend).needs_tangents());

    Scene back = bumped(0.5f);
    const std::int32_t behind = static_cast<std::int32_t>(back.materials.size()) - 1;
    const std::int32_t front = test::add_material(back, DiffuseMaterial{Rgb(0.5f)}, true);
    back.materials[static_cast<std::size_t>(front)].back = behind;
    EXPECT_TRUE(PreparedMaterial(back).needs_tangents());

    Scene brushed = plain;
    ConductorMaterial metal;
    metal.roughness = test::rough(Microfacets::ggx, 0.1f, 0.3f);
    const std::int32_t anisotropic = test::add_material(brushed, metal);
    test::add_material(brushed, BlendMaterial{FloatInput(0.5f), textured, anisotropic});
    EXPECT_TRUE(PreparedMaterial(brushed).needs_tangents());
}

TEST(Bump, BackSeesTheSameTiltedSurface) {
    PreparedMaterial prepared(bumped(0.5f, true));
    // The frame of the back is mirrored in z: the tilted normal, reversed, is (0.5, 0, 1) there.
    const Bsdf& bsdf = prepared.at(point_at(0.5f, 0.5f, kUp, true), true);
    const auto* frame = std::get_if<OrientedBsdf>(&bsdf.kind);
    ASSERT_NE(frame, nullptr);
    EXPECT_LT((frame->n - normalize(Vec3(0.5f, 0.0f, 1.0f))).length(), 1e-4f);
}

TEST(Bump, NeitherLeaksNorTurnsBlack) {
    PreparedMaterial prepared(bumped(4.0f));
    int black = 0;
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const Draw r = draw({23, i, 0}, 0, Stream::scatter);
        const Vec3 wo = square_to_cosine_hemisphere({to_unit(r[0]), to_unit(r[1])});
        if (!(wo.z > 0.0f)) continue;
        const Bsdf& bsdf = prepared.at(point_at(0.5f, 0.5f, wo));
        const auto* frame = std::get_if<OrientedBsdf>(&bsdf.kind);
        ASSERT_NE(frame, nullptr);
        ASSERT_GT(dot(frame->n, wo), 0.0f);
        const Vec3 below = square_to_sphere({to_unit(r[2]), to_unit(r[3])});
        if (below.z < 0.0f) {
            ASSERT_EQ(bsdf.value(wo, below).f_cos.x, 0.0f) << "light from behind the surface";
        }
        bool any = false;
        for (std::uint32_t k = 0; k < 8 && !any; ++k) {
            const Draw d = draw({29, i, k}, 0, Stream::scatter);
            const BsdfSample s = bsdf.sample(wo, {to_unit(d[0]), {to_unit(d[1]), to_unit(d[2])}});
            if (s.pdf > 0.0f) {
                ASSERT_GT(s.wi.z, 0.0f);
                any = s.f_cos.x > 0.0f;
            }
        }
        black += !any;
    }
    EXPECT_LT(black, 40);
}

TEST(NormalMap, FlatIsTheSurface) {
    for (const bool mirrored : {false, true}) {
        Scene scene;
        const std::int32_t flat = test::add_image_texture(scene, 1, 1, {0.5f, 0.5f, 1.0f});
        const std::int32_t material = test::add_material(scene, DiffuseMaterial{Rgb(1.0f)}, true);
        scene.materials[static_cast<std::size_t>(material)].detail.normal_map = flat;
        PreparedMaterial prepared(scene);
        const Bsdf& bsdf = prepared.at(point_at(0.5f, 0.5f, kUp, mirrored), mirrored);
        EXPECT_LT((std::get<OrientedBsdf>(bsdf.kind).n - kUp).length(), 1e-6f);
    }
}

TEST(NormalMap, TiltsAlongTheTangent) {
    Scene scene;
    const std::int32_t map = test::add_image_texture(scene, 1, 1, {0.8f, 0.5f, 0.9f});
    const std::int32_t material = test::add_material(scene, DiffuseMaterial{Rgb(1.0f)}, true);
    scene.materials[static_cast<std::size_t>(material)].detail.normal_map = map;
    PreparedMaterial prepared(scene);
    ShadingPoint point = point_at(0.5f, 0.5f);
    point.dp_du = {0.0f, 2.0f, 0.0f};
    point.dp_dv = {-1.0f, 0.0f, 0.0f};
    const Vec3 n = std::get<OrientedBsdf>(prepared.at(point).kind).n;
    EXPECT_LT((n - normalize(Vec3(0.0f, 0.6f, 0.8f))).length(), 1e-5f);
}

/// Encoded as a normal map stores it.
Rgb stored(const Vec3& n) {
    return (n + Vec3(1.0f)) * 0.5f;
}

/// A white surface whose normals are those of a board: `first` at (0.1, 0.1), `second` at (0.6, 0.1).
Scene tilted_board(const Vec3& first, const Vec3& second, const NormalDetail& detail = {}) {
    Scene scene;
    const std::int32_t board = test::add_board(scene, stored(first), stored(second));
    const std::int32_t material = test::add_material(scene, DiffuseMaterial{Rgb(1.0f)}, true);
    NormalDetail& own = scene.materials[static_cast<std::size_t>(material)].detail = detail;
    own.normal_map = board;
    return scene;
}

Vec3 normal_of(const Bsdf& bsdf) {
    return std::get<OrientedBsdf>(bsdf.kind).n;
}

TEST(NormalMap, IsReadFromEveryKindOfTexture) {
    const Vec3 first(0.6f, 0.0f, 0.8f), second(0.0f, -0.6f, 0.8f);
    PreparedMaterial prepared(tilted_board(first, second));
    EXPECT_LT((normal_of(prepared.at(point_at(0.1f, 0.1f))) - first).length(), 1e-6f);
    EXPECT_LT((normal_of(prepared.at(point_at(0.6f, 0.1f))) - second).length(), 1e-6f);
    // A factor on the texture is one on the stored numbers, not on the normal.
    NormalDetail scaled;
    scaled.normal_scale = {0.5f, 1.0f, 1.0f};
    PreparedMaterial factor(tilted_board(first, second, scaled));
    EXPECT_LT((normal_of(factor.at(point_at(0.1f, 0.1f))) - normalize(Vec3(-0.2f, 0.0f, 0.8f))).length(), 1e-6f);
}

TEST(Bump, OfABoardHasSlopesAtItsEdgesOnly) {
    Scene scene;
    const std::int32_t board = test::add_board(scene, Rgb(0.0f), Rgb(1.0f));
    const std::int32_t material = test::add_material(scene, DiffuseMaterial{Rgb(1.0f)});
    scene.materials[static_cast<std::size_t>(material)].detail.bump = board;
    PreparedMaterial prepared(scene);
    for (const float u : {0.1f, 0.4f, 0.6f, 0.9f})
        EXPECT_EQ(normal_of(prepared.at(point_at(u, 0.3f))), kUp) << u;
}

/// A normal that faces away is turned as by Mitsuba 3.7.1; else it is bent until it faces wo.
TEST(NormalMap, TurnsWhatFacesAway) {
    const Vec3 tilted(0.8f, 0.0f, 0.6f), away = normalize(Vec3(-0.9f, 0.1f, 0.4f));
    NormalDetail flips;
    flips.flip_invalid = true;
    PreparedMaterial turned(tilted_board(tilted, kUp, flips)), bent(tilted_board(tilted, kUp));
    EXPECT_LT((normal_of(turned.at(point_at(0.1f, 0.1f, away))) - Vec3(-0.8f, 0.0f, 0.6f)).length(), 1e-6f);
    EXPECT_LT((normal_of(turned.at(point_at(0.1f, 0.1f))) - tilted).length(), 1e-6f) << "seen from above it is valid";
    EXPECT_GT(normal_of(bent.at(point_at(0.1f, 0.1f, away))).x, 0.0f);
    EXPECT_GT(dot(normal_of(bent.at(point_at(0.1f, 0.1f, away))), away), 0.0f);
}

/// Shadowing with alpha^2 = tan^2 of the tilt over 8, of Ray Tracing Gems.
TEST(NormalMap, ShadowsGrazingLightAsThePaperSays) {
    const Vec3 tilted(0.6f, 0.0f, 0.8f), wo = normalize(Vec3(0.2f, 0.1f, 0.9f));
    NormalDetail shadowed;
    shadowed.shadowed = true;
    PreparedMaterial with(tilted_board(tilted, kUp, shadowed)), without(tilted_board(tilted, kUp));
    const Bsdf &dim = with.at(point_at(0.1f, 0.1f, wo)), &bright = without.at(point_at(0.1f, 0.1f, wo));
    const double alpha2 = 0.5625 / 8;
    double energy = 0;
    constexpr int kSamples = 20000;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const Draw r = draw({31, i, 0}, 0, Stream::scatter);
        const BsdfSample s = dim.sample(wo, {to_unit(r[0]), {to_unit(r[1]), to_unit(r[2])}});
        if (!(s.pdf > 0.0f)) continue;
        energy += double(s.f_cos.x / s.pdf) / kSamples;
        if (s.wi.z < 1e-3f) continue;
        const double tangent2 = 1.0 / (double(s.wi.z) * double(s.wi.z)) - 1.0;
        const double factor = 2.0 / (1.0 + std::sqrt(1.0 + alpha2 * tangent2));
        const BsdfValue dimmed = dim.value(wo, s.wi), whole = bright.value(wo, s.wi);
        ASSERT_NEAR(dimmed.f_cos.x, factor * double(whole.f_cos.x), 1e-5 * double(whole.f_cos.x) + 1e-9);
        ASSERT_NEAR(s.f_cos.x, dimmed.f_cos.x, 1e-4f * dimmed.f_cos.x + 1e-9f) << "as sampled";
        ASSERT_EQ(dimmed.pdf, whole.pdf);
    }
    EXPECT_LT(energy, 0.95) << "a tilted white surface sends some light below the surface, and shadows some";
    EXPECT_GT(energy, 0.7);
}

TEST(Anisotropic, IsWideAlongItsTangent) {
    const ConductorMaterial metal{Rgb(0.0f), Rgb(1.0f), Rgb(1.0f), test::rough(Microfacets::ggx, 0.4f, 0.05f)};
    PreparedMaterial prepared{decltype(Material::bsdf)(metal)};
    ASSERT_TRUE(prepared.varies());
    for (const bool mirrored : {false, true}) {
        ShadingPoint point = point_at(0.0f, 0.0f, kUp, mirrored);
        point.dp_du = {0.0f, 3.0f, 1.0f};
        const Bsdf& bsdf = mirrored ? prepared.at(point_at(0, 0)) : prepared.at(point);
        const Vec3 along = mirrored ? Vec3(0.5f, 0, 0) : Vec3(0, 0.5f, 0), across(along.y, along.x, 0);
        EXPECT_GT(bsdf.value(kUp, normalize(along + kUp)).f_cos.x,
                  20.0f * bsdf.value(kUp, normalize(across + kUp)).f_cos.x);
    }
}

// A texture is 0 where it likes, also between texels of what is not: the roughness is clamped at the lookup.
TEST(Textured, RoughnessIsClampedWhereItIsLookedUp) {
    constexpr float kU[] = {0.125f, 0.375f, 0.625f, 0.875f};
    const float values[] = {0.0f, 1e-6f, 0.3f, 1e30f}, clamped[] = {1e-4f, 1e-4f, 0.3f, 1e6f};
    for (const Microfacets kind : {Microfacets::ggx, Microfacets::beckmann})
        for (const char* name : {"metal", "glass", "plastic"}) {
            const auto material = [&](const FloatInput& alpha) -> decltype(Material::bsdf) {
                const Roughness roughness{kind, alpha, alpha};
                if (name[0] == 'm') return ConductorMaterial{Rgb(0.2f), Rgb(3.0f), Rgb(1.0f), roughness};
                if (name[0] == 'g') return DielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), roughness};
                return PlasticMaterial{1.5f, Rgb(0.5f), Rgb(1.0f), false, roughness};
            };
            Scene scene;
            std::vector<float> texels;
            for (const float value : values)
                texels.insert(texels.end(), 3, value);
            const std::int32_t map = test::add_image_texture(scene, 4, 1, texels);
            std::get<BitmapTexture>(scene.textures[static_cast<std::size_t>(map)].kind).bilinear = false;
            test::add_material(scene, material(FloatInput(1.0f, map)));
            PreparedMaterial textured(scene);
            ASSERT_TRUE(textured.varies());
            const Vec3 wo = normalize(Vec3(0.4f, 0.2f, 0.7f));
            for (std::size_t i = 0; i < std::size(kU); ++i) {
                PreparedMaterial constant(material(FloatInput(clamped[i])));
                const Bsdf& looked_up = textured.at(point_at(kU[i], 0.5f, wo));
                for (const float u : {0.05f, 0.3f, 0.7f, 0.95f}) {
                    const BsdfRandom random{u, {u, 1.0f - u}};
                    const BsdfSample sample = looked_up.sample(wo, random);
                    const BsdfSample expected = constant.varies()
                                                    ? constant.at(point_at(0.5f, 0.5f, wo)).sample(wo, random)
                                                    : constant.front().sample(wo, random);
                    EXPECT_TRUE(is_finite(sample.wi) && is_finite(sample.f_cos) && std::isfinite(sample.pdf))
                        << name << " " << values[i];
                    // The table of a plastic's coat ends at alpha = 1.
                    if (clamped[i] <= 1.0f || name[0] != 'p') {
                        EXPECT_LT((sample.wi - expected.wi).length(), 1e-5f) << name << " " << values[i];
                    }
                    if (sample.pdf > 0.0f) {
                        const Rgb f = looked_up.value(wo, sample.wi).f_cos;
                        EXPECT_TRUE(is_finite(f)) << name << " " << values[i];
                    }
                }
            }
        }
}

TEST(Constant, MaterialsAreNotLookedUp) {
    const PreparedMaterial metal(
        ConductorMaterial{Rgb(0.2f), Rgb(3.0f), Rgb(1.0f), test::rough(Microfacets::ggx, 0.2f, 0.2f)});
    EXPECT_FALSE(metal.varies());
    EXPECT_NE(metal.side(false), nullptr);
}

}  // namespace
}  // namespace treefarm
