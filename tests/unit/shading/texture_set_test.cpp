// SPDX-License-Identifier: Apache-2.0
#include "worker/textures/texture_set.h"

#include <gtest/gtest.h>

#include <limits>

namespace treefarm {
namespace {

/// Values 0 to 5 in 3 x 2 grey texels.
TextureImage small_image() {
    TextureImage image;
    image.width = 3;
    image.height = 2;
    image.channels = 1;
    image.floats = {0, 1, 2, 3, 4, 5};
    return image;
}

TextureSet bitmap(TextureImage image, BitmapTexture texture) {
    texture.image = 0;
    return TextureSet({{texture, "", {}}}, {std::move(image)});
}

TextureSet nearest(Wrap u, Wrap v) {
    return bitmap(small_image(), {0, false, u, v, {}});
}

/// Texture coordinates of the middle of a texel, also outside of the image.
Vec2 middle(int x, int y) {
    return {(static_cast<float>(x) + 0.5f) / 3.0f, (static_cast<float>(y) + 0.5f) / 2.0f};
}

TEST(TextureSet, TexelsAreWhereTheInterfaceSays) {
    const TextureSet set = nearest(Wrap::repeat, Wrap::repeat);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x)
            EXPECT_EQ(set.value(0, middle(x, y)), static_cast<float>(3 * y + x));
}

TEST(TextureSet, WrapsOnEachAxis) {
    EXPECT_EQ(nearest(Wrap::repeat, Wrap::clamp).value(0, middle(3, 0)), 0.0f);
    EXPECT_EQ(nearest(Wrap::repeat, Wrap::clamp).value(0, middle(-1, 5)), 5.0f);
    EXPECT_EQ(nearest(Wrap::clamp, Wrap::repeat).value(0, middle(7, 2)), 2.0f);
    EXPECT_EQ(nearest(Wrap::clamp, Wrap::repeat).value(0, middle(-7, -1)), 3.0f);
    EXPECT_EQ(nearest(Wrap::mirror, Wrap::mirror).value(0, middle(3, 0)), 2.0f);
    EXPECT_EQ(nearest(Wrap::mirror, Wrap::mirror).value(0, middle(6, 0)), 0.0f);
    EXPECT_EQ(nearest(Wrap::mirror, Wrap::mirror).value(0, middle(-1, -1)), 0.0f);
    EXPECT_EQ(nearest(Wrap::mirror, Wrap::mirror).value(0, middle(-4, 2)), 5.0f);
    EXPECT_EQ(nearest(Wrap::zero, Wrap::repeat).value(0, middle(3, 1)), 0.0f);
    EXPECT_EQ(nearest(Wrap::one, Wrap::repeat).value(0, middle(-1, 1)), 1.0f);
    EXPECT_EQ(nearest(Wrap::zero, Wrap::repeat).value(0, middle(2, 1)), 5.0f);
}

TEST(TextureSet, InterpolatesBetweenTheMiddles) {
    const TextureSet set = bitmap(small_image(), {0, true, Wrap::clamp, Wrap::clamp, {}});
    EXPECT_NEAR(set.value(0, middle(1, 0)), 1.0f, 1e-5f);
    EXPECT_NEAR(set.value(0, {0.5f, 0.5f}), 2.5f, 1e-5f);
    EXPECT_NEAR(set.value(0, {(0.5f + 0.25f) / 3, 0.25f}), 0.25f, 1e-5f);
    EXPECT_NEAR(set.value(0, {0.0f, 0.0f}), 0.0f, 1e-5f);
    const TextureSet around = bitmap(small_image(), {0, true, Wrap::repeat, Wrap::clamp, {}});
    EXPECT_NEAR(around.value(0, {0.0f, 0.0f}), 1.0f, 1e-5f) << "halfway between the first and the last column";
    EXPECT_NEAR(around.value(0, {1.0f, 0.0f}), 1.0f, 1e-5f);
}

TEST(TextureSet, TransformsCoordinatesFirst) {
    BitmapTexture texture{0, false, Wrap::repeat, Wrap::repeat, {}};
    texture.uv.u_row = {0, 2, 1.0f / 3};  // u' = 2 v + 1/3
    texture.uv.v_row = {1, 0, 0};
    const TextureSet set = bitmap(small_image(), texture);
    EXPECT_EQ(set.value(0, {0.25f, 1.0f / 12}), 1.0f);
    EXPECT_EQ(set.value(0, {0.75f, 1.0f / 4}), 5.0f);
}

TEST(TextureSet, HugeAndInvalidCoordinatesGiveSomeTexel) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp, Wrap::zero, Wrap::one})
        for (const bool bilinear : {false, true}) {
            const TextureSet set = bitmap(small_image(), {0, bilinear, wrap, wrap, {}});
            for (const float x : {1e6f, -1e6f, 4e6f, 1e30f, -1e30f, kInfinity, -kInfinity, std::nanf("")})
                for (const Vec2& uv : {Vec2(x, 0.3f), Vec2(0.3f, x), Vec2(x, x)}) {
                    const float value = set.value(0, uv);
                    EXPECT_TRUE(value >= 0.0f && value <= 5.0f) << uv;
                    EXPECT_TRUE(std::isfinite(set.gradient(0, uv).x));
                }
        }
}

TEST(TextureSet, BytesAreDecodedByTheirTable) {
    TextureImage image;
    image.width = image.height = 1;
    image.channels = 3;
    image.bytes = {0, 128, 255};
    for (std::size_t i = 0; i < 256; ++i)
        image.decode[i] = static_cast<float>(i * i);
    const TextureSet set = bitmap(image, {});
    EXPECT_EQ(set.color(0, {0.5f, 0.5f}), Rgb(0, 16384, 65025));
    EXPECT_NEAR(set.value(0, {0.5f, 0.5f}), (16384.0f + 65025.0f) / 3, 1e-2f);
    EXPECT_EQ(set.memory(), 3u);
}

TEST(TextureSet, GradientFollowsARamp) {
    TextureImage image;
    image.width = 8;
    image.height = 4;
    image.channels = 1;
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            image.floats.push_back(2.0f * static_cast<float>(x) + 3.0f * static_cast<float>(y));
    const TextureSet set = bitmap(image, {0, true, Wrap::clamp, Wrap::clamp, {}});
    const Vec2 gradient = set.gradient(0, {0.5f, 0.5f});
    EXPECT_NEAR(gradient.x, 16.0f, 1e-3f);
    EXPECT_NEAR(gradient.y, 12.0f, 1e-3f);
    BitmapTexture turned{0, true, Wrap::clamp, Wrap::clamp, {}};
    turned.uv.u_row = {0, 1, 0};
    turned.uv.v_row = {0.5f, 0, 0.25f};
    const Vec2 other = bitmap(image, turned).gradient(0, {0.5f, 0.5f});
    EXPECT_NEAR(other.x, 6.0f, 1e-3f);
    EXPECT_NEAR(other.y, 16.0f, 1e-3f);
}

TEST(TextureSet, Checkerboard) {
    CheckerboardTexture board{Rgb(1.0f), Rgb(0.25f), {}};
    board.uv.u_row = {2, 0, 0};
    const TextureSet set({{board, "", {}}}, {});
    EXPECT_EQ(set.value(0, {0.1f, 0.1f}), 1.0f);
    EXPECT_EQ(set.value(0, {0.3f, 0.1f}), 0.25f);
    EXPECT_EQ(set.value(0, {0.3f, 0.6f}), 1.0f);
    EXPECT_EQ(set.value(0, {-0.1f, 0.1f}), 0.25f);
    EXPECT_EQ(set.value(0, {-0.1f, -0.1f}), 1.0f);
    EXPECT_EQ(set.gradient(0, {0.3f, 0.6f}), Vec2(0.0f));
}

/// The mesh as a set of textures wants it.
Mesh arranged(const TextureSet& set, const Mesh& mesh) {
    return std::get<Mesh>(set.arranged({{mesh, kNone, kNone, kNone, "", {}}})[0].geometry);
}

Mesh painted_square() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.indices = {2, 0, 1, 1, 3, 2};
    mesh.attributes = {{"vertex_color", {Rgb(0, 8, 0), Rgb(0, 0, 16), Rgb(4, 0, 0), Rgb(1)}},
                       {"face_wear", {Rgb(1, 2, 3), Rgb(4, 5, 6)}}};
    return mesh;
}

TextureSet painted() {
    return TextureSet({{MeshAttributeTexture{"vertex_color"}, "", {}}, {MeshAttributeTexture{"face_wear"}, "", {}}},
                      {});
}

TEST(TextureSet, AttributesOfAMeshAreInterpolatedOverTrianglesOrOneForEach) {
    const TextureSet set = painted();
    const Mesh mesh = arranged(set, painted_square());
    EXPECT_TRUE(set.reads_meshes());
    EXPECT_FALSE(nearest(Wrap::repeat, Wrap::repeat).reads_meshes());
    // a quarter of the way to vertex 0 (the second corner), half of it to vertex 1: the rest is vertex 2
    const MeshPoint first{&mesh, 0, 0.25f, 0.5f}, second{&mesh, 1, 0.25f, 0.5f};
    EXPECT_EQ(set.color(0, {Vec2(7.0f), &first}), Rgb(1, 2, 8));
    EXPECT_EQ(set.color(0, {Vec2(7.0f), &second}), Rgb(0, 0, 16) * 0.25f + Rgb(1) * 0.25f + Rgb(4, 0, 0) * 0.5f);
    EXPECT_EQ(set.color(1, {Vec2(7.0f), &first}), Rgb(1, 2, 3));
    EXPECT_EQ(set.color(1, {Vec2(7.0f), &second}), Rgb(4, 5, 6));
    EXPECT_EQ(set.eval(ColorInput(Rgb(2), 1), {Vec2(0.0f), &second}), Rgb(8, 10, 12));
}

TEST(TextureSet, AttributesAreNotLookedUpByName) {
    // Names are resolved once: whatever a mesh calls its attributes afterwards, in whatever order it had them.
    const TextureSet set({{MeshAttributeTexture{"face_wear"}, "", {}},
                          {CheckerboardTexture{}, "", {}},
                          {MeshAttributeTexture{"vertex_color"}, "", {}},
                          {MeshAttributeTexture{"face_wear"}, "", {}}},
                         {});
    Mesh unasked = painted_square();
    unasked.attributes.insert(unasked.attributes.begin(), MeshAttribute{"vertex_heat", std::vector<Rgb>(4, Rgb(9))});
    Mesh turned = painted_square();
    std::swap(turned.attributes[0], turned.attributes[1]);
    for (Mesh mesh : {painted_square(), turned, unasked}) {
        mesh = arranged(set, mesh);
        EXPECT_EQ(mesh.attributes.size(), 2u);
        for (MeshAttribute& attribute : mesh.attributes)
            attribute.name = "renamed";
        const MeshPoint first{&mesh, 0, 0.25f, 0.5f}, second{&mesh, 1, 0.25f, 0.25f};
        for (const std::int32_t texture : {0, 3}) {
            EXPECT_EQ(set.color(texture, {Vec2(7.0f), &first}), Rgb(1, 2, 3));
            EXPECT_EQ(set.color(texture, {Vec2(7.0f), &second}), Rgb(4, 5, 6));
        }
        EXPECT_EQ(set.color(2, {Vec2(7.0f), &first}), Rgb(1, 2, 8));
    }
}

TEST(TextureSet, AMeshWithoutAnAttributeIsBlackWhereItIsAskedFor) {
    const TextureSet set = painted();
    Mesh mesh = painted_square();
    mesh.attributes.erase(mesh.attributes.begin());
    for (const bool has_another : {true, false}) {
        if (!has_another) mesh.attributes.clear();
        const Mesh here = arranged(set, mesh);
        const MeshPoint point{&here, 1, 0.25f, 0.5f};
        EXPECT_EQ(set.color(0, {Vec2(0.0f), &point}), Rgb(0.0f));
        EXPECT_EQ(set.gradient(0, {Vec2(0.0f), &point}), Vec2(0.0f));
        EXPECT_EQ(set.color(1, {Vec2(0.0f), &point}), has_another ? Rgb(4, 5, 6) : Rgb(0.0f));
    }
}

TEST(TextureSet, TheGradientOfAnAttributeIsThatOfItsInterpolation) {
    const TextureSet set = painted();
    Mesh mesh = arranged(set, painted_square());
    for (const bool has_uvs : {false, true}) {
        if (has_uvs) mesh.uvs = {{0.125f, 0.25f}, {2.0f, 0.5f}, {0.5f, -1.0f}, {1.0f, 1.5f}};
        for (const std::uint32_t triangle : {0u, 1u}) {
            const auto at = [&](float b1, float b2) { return MeshPoint{&mesh, triangle, b1, b2}; };
            const auto uv = [&](float b1, float b2) {
                if (!has_uvs) return Vec2(b1, b2);
                const std::uint32_t* corner = &mesh.indices[3 * triangle];
                return mesh.uvs[corner[0]] * (1.0f - b1 - b2) + mesh.uvs[corner[1]] * b1 + mesh.uvs[corner[2]] * b2;
            };
            const MeshPoint here = at(0.25f, 0.25f);
            const Vec2 gradient = set.gradient(0, {uv(0.25f, 0.25f), &here});
            for (const Vec2& step : {Vec2(0.5f, 0.0f), Vec2(0.0f, 0.5f), Vec2(-0.25f, 0.5f)}) {
                const MeshPoint there = at(0.25f + step.x, 0.25f + step.y);
                const Vec2 way = uv(0.25f + step.x, 0.25f + step.y) - uv(0.25f, 0.25f);
                EXPECT_NEAR(gradient.dot(way), set.value(0, {Vec2(0.0f), &there}) - set.value(0, {Vec2(0.0f), &here}),
                            1e-5f);
            }
            EXPECT_EQ(set.gradient(1, {Vec2(0.5f), &here}), Vec2(0.0f));
        }
    }
    mesh.uvs.assign(4, Vec2(0.5f));
    const MeshPoint here{&mesh, 0, 0.25f, 0.25f};
    EXPECT_EQ(set.gradient(0, {Vec2(0.5f), &here}), Vec2(0.0f)) << "all corners at one place of the texture";
}

TEST(TextureSet, InputsAreFactorsOfTheirTextures) {
    const TextureSet set = nearest(Wrap::repeat, Wrap::repeat);
    EXPECT_EQ(set.eval(ColorInput(Rgb(1, 2, 3)), middle(1, 1)), Rgb(1, 2, 3));
    EXPECT_EQ(set.eval(ColorInput(Rgb(1, 2, 3), 0), middle(1, 1)), Rgb(4, 8, 12));
    EXPECT_EQ(set.eval(FloatInput(0.5f), middle(1, 1)), 0.5f);
    EXPECT_EQ(set.eval(FloatInput(0.5f, 0), middle(1, 1)), 2.0f);
}

TEST(TextureSet, GridsHaveLinesAtWholeCoordinates) {
    GridTexture grid{Rgb(0.2f), Rgb(0.4f), 0.05f, {Vec3(10, 0, 0), Vec3(0, 1, 0)}};
    const TextureSet set({{grid, "", {}}}, {});
    for (const float u : {0.05f, -0.05f, 0.55f})
        EXPECT_FLOAT_EQ(set.value(0, TexturePoint(u, 0.5f)), 0.2f) << u;
    for (const float u : {0.0f, 0.004f, 0.096f, -0.3f, 7.1f})
        EXPECT_FLOAT_EQ(set.value(0, TexturePoint(u, 0.5f)), 0.4f) << u;
    EXPECT_FLOAT_EQ(set.value(0, TexturePoint(0.05f, 2.96f)), 0.4f);
}

TEST(TextureSet, WiresFollowTheEdgesOfTriangles) {
    WireframeTexture wires;
    wires.edge = Rgb(0.0f), wires.interior = Rgb(1.0f);
    wires.line_width = 0.4f;
    const TextureSet set({{wires, "", {}}}, {});
    EXPECT_TRUE(set.reads_meshes());
    Mesh mesh;
    mesh.positions = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(0, 4, 0)};
    mesh.indices = {0, 1, 2};
    const auto at = [&](float x, float y) {
        const MeshPoint point{&mesh, 0, x / 4, y / 4};
        return set.value(0, {Vec2(0.0f), &point});
    };
    EXPECT_EQ(at(1.0f, 1.0f), 1.0f) << "inside";
    EXPECT_EQ(at(1.0f, 0.1f), 0.0f) << "at an edge";
    EXPECT_EQ(at(0.1f, 1.0f), 0.0f);
    EXPECT_EQ(at(1.95f, 1.95f), 0.0f) << "at the third";
    EXPECT_NEAR(at(1.0f, 0.3f), 0.5f, 1e-5f) << "amid the step, from 0.2 to 0.4";
    EXPECT_EQ(set.value(0, TexturePoint(0.5f, 0.5f)), 1.0f) << "no mesh";
}

}  // namespace
}  // namespace treefarm
