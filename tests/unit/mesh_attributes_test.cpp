// SPDX-License-Identifier: Apache-2.0
// Colours of meshes wherever a texture may stand, against images that are the same function.
#include <gtest/gtest.h>

#include "coordinator/input/check/validate.h"
#include "coordinator/input/meshes/mesh_normals.h"
#include "tests/support/local_render.h"
#include "tests/support/material_scenes.h"

namespace treefarm {
namespace {

enum class Slot { reflectance, roughness, weight, opacity, bump, normal_map, back, radiance };

/// Colours at the left and at the right of a square, whose u runs from 1/4 to 3/4: seen as directions of a normal map,
/// too.
const Rgb kLeft(0.3f, 0.5f, 0.9f), kRight(0.7f, 0.4f, 0.8f);

std::int32_t add_texture(Scene& scene, bool as_attribute) {
    if (as_attribute) {
        scene.textures.push_back({MeshAttributeTexture{"vertex_color"}, "painted", {}});
        return static_cast<std::int32_t>(scene.textures.size()) - 1;
    }
    std::vector<float> rgb;
    for (const float u : {0.125f, 0.375f, 0.625f, 0.875f})
        for (int c = 0; c < 3; ++c)
            rgb.push_back(kLeft[c] + (kRight[c] - kLeft[c]) * (u - 0.25f) / 0.5f);
    const std::int32_t texture = test::add_image_texture(scene, 4, 1, rgb);
    auto& bitmap = std::get<BitmapTexture>(scene.textures.back().kind);
    bitmap.wrap_u = bitmap.wrap_v = Wrap::clamp;
    return texture;
}

/// A square above a floor with one texture in that slot.
Scene square_with(Slot slot, bool as_attribute) {
    Scene scene;
    const std::int32_t white = test::add_diffuse(scene, Rgb(0.7f), true);
    const std::int32_t texture = add_texture(scene, as_attribute);
    const ColorInput color(Rgb(0.9f), texture);
    std::int32_t material = white;
    if (slot == Slot::reflectance || slot == Slot::bump)
        material = test::add_material(scene, DiffuseMaterial{color}, true);
    if (slot == Slot::roughness) {
        ConductorMaterial metal{Rgb(0.2f, 0.9f, 1.1f), Rgb(3.9f, 2.4f, 2.2f), Rgb(0.9f), {}};
        metal.roughness = {Microfacets::ggx, {0.5f, texture}, {0.5f, texture}};
        material = test::add_material(scene, metal, true);
    }
    if (slot == Slot::weight)
        material = test::add_material(
            scene,
            BlendMaterial{{1.0f, texture}, test::add_diffuse(scene, Rgb(0.1f)), test::add_diffuse(scene, Rgb(0.9f))},
            true);
    if (slot == Slot::opacity || slot == Slot::normal_map || slot == Slot::back)
        material = test::add_diffuse(scene, Rgb(0.6f, 0.7f, 0.8f), true);
    Material& made = scene.materials[static_cast<std::size_t>(material)];
    if (slot == Slot::opacity) made.opacity = {0.8f, texture};
    if (slot == Slot::bump) made.detail.bump = texture, made.detail.bump_scale = 0.5f;
    if (slot == Slot::normal_map) made.detail.normal_map = texture;
    if (slot == Slot::back) {
        const std::int32_t behind = test::add_material(scene, DiffuseMaterial{color});
        std::swap(scene.materials[static_cast<std::size_t>(behind)],
                  scene.materials[static_cast<std::size_t>(material)]);
        scene.materials[static_cast<std::size_t>(behind)].back = material;
        material = behind;
    }
    Mesh square = slot == Slot::back ? test::quad({-1, -1, 0}, {0, 2, 0}, {2, 0, 0})
                                     : test::quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
    for (const Vec3& p : square.positions) {
        square.uvs.emplace_back(p.x < 0.0f ? 0.25f : 0.75f, p.y < 0.0f ? 0.0f : 1.0f);
        if (as_attribute) {
            if (square.attributes.empty()) square.attributes.push_back({"vertex_color", {}});
            square.attributes[0].values.push_back(p.x < 0.0f ? kLeft : kRight);
        }
    }
    const std::int32_t shape = test::add_shape(scene, square, material);
    if (slot == Slot::radiance) {
        scene.shapes[static_cast<std::size_t>(shape)].emitter = static_cast<std::int32_t>(scene.emitters.size());
        scene.emitters.push_back({AreaEmitter{ColorInput(Rgb(2.0f), texture), shape}, {}});
    }
    test::add_shape(scene, test::quad({-3, -3, -1}, {6, 0, 0}, {0, 6, 0}), white);
    test::add_shape(scene, test::quad({-1, -1, 4}, {0, 1, 0}, {1, 0, 0}), white, Rgb(9.0f, 8.0f, 7.0f));
    scene.camera = test::look_at({0.2f, -0.5f, 3.0f}, Vec3(0.0f), Vec3(0, 1, 0), 0.4f);
    test::set_film(scene, 16, 16);
    std::vector<Warning> warnings;
    validate_scene(scene, warnings);
    EXPECT_TRUE(warnings.empty());
    return scene;
}

class MeshAttributes : public testing::TestWithParam<Slot> {};

/// Random numbers follow from the path, so the pictures differ by rounding alone, but for paths that it sends
/// elsewhere.
TEST_P(MeshAttributes, AreTheImageThatIsTheSameFunction) {
    for (const char* type : {"path", "reference"}) {
        Job job;
        job.integrator.type = type;
        job.budget.spp = 16;
        job.guiding.type = GuidingType::none;
        const CombinedImage painted = test::render_locally(square_with(GetParam(), true), job).image;
        const CombinedImage image = test::render_locally(square_with(GetParam(), false), job).image;
        ASSERT_EQ(painted.mean.size(), image.mean.size());
        double difference = 0, sum = 0;
        for (std::size_t p = 0; p < image.mean.size(); ++p) {
            const Rgb64 apart = painted.mean[p] - image.mean[p];
            difference += std::abs(apart.x) + std::abs(apart.y) + std::abs(apart.z);
            sum += image.mean[p].x + image.mean[p].y + image.mean[p].z;
        }
        EXPECT_GT(sum, 1.0);
        EXPECT_LT(difference, 1e-3 * sum) << type;
    }
}

INSTANTIATE_TEST_SUITE_P(EverySlot, MeshAttributes,
                         testing::Values(Slot::reflectance, Slot::roughness, Slot::weight, Slot::opacity, Slot::bump,
                                         Slot::normal_map, Slot::back, Slot::radiance));

TEST(MeshAttributesOfSplitMeshes, StayWithTheirVertices) {
    Mesh roof;  // two squares that meet in an edge
    test::append_quad(roof, {0, 0, 0}, {1, 0, 1}, {0, 1, 0});
    test::append_quad(roof, {1, 0, 1}, {1, 0, -1}, {0, 1, 0});
    roof.attributes = {{"vertex_color", {}}, {"face_color", {Rgb(1), Rgb(2), Rgb(3), Rgb(4)}}};
    for (const Vec3& p : roof.positions)
        roof.attributes[0].values.push_back(Rgb(p.x, p.y, p.z));
    for (const double min_cosine : {-1.0, 0.5}) {
        Mesh split = roof;
        split_at_edges(split, min_cosine);
        EXPECT_EQ(split.positions.size(), min_cosine > 0.0 ? 8u : 6u);
        ASSERT_EQ(split.attributes.size(), 2u);
        for (std::size_t i = 0; i < split.positions.size(); ++i)
            EXPECT_EQ(split.attributes[0].values.at(i), Rgb(split.positions[i]));
        EXPECT_EQ(split.attributes[1].values, roof.attributes[1].values);
    }
}

}  // namespace
}  // namespace treefarm
