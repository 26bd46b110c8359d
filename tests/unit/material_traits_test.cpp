// SPDX-License-Identifier: Apache-2.0
#include "common/scene/uses/material_traits.h"

#include <gtest/gtest.h>

namespace treefarm {
namespace {

template <class Kind>
std::int32_t add(Scene& scene, Kind bsdf) {
    Material material;
    material.bsdf = std::move(bsdf);
    scene.materials.push_back(std::move(material));
    return static_cast<std::int32_t>(scene.materials.size() - 1);
}

void use(Scene& scene, std::int32_t material) {
    Shape shape;
    shape.geometry = Sphere{};
    shape.material = material;
    scene.shapes.push_back(shape);
}

Roughness rough(float u, float v) {
    return {Microfacets::ggx, {u}, {v}};
}

Lobes lobes_of(const auto& bsdf) {
    Scene scene;
    return material_traits(scene, add(scene, bsdf)).lobes;
}

TEST(MaterialTraits, EveryKindHasItsLobes) {
    EXPECT_EQ(lobes_of(DiffuseMaterial{}), (Lobes{.diffuse = true}));
    EXPECT_EQ(lobes_of(ConductorMaterial{}), (Lobes{.delta_reflection = true}));
    EXPECT_EQ(lobes_of(ConductorMaterial{.roughness = rough(0.1f, 0.1f)}), (Lobes{.glossy_reflection = true}));
    EXPECT_EQ(lobes_of(DielectricMaterial{}), (Lobes{.delta_reflection = true, .delta_transmission = true}));
    EXPECT_EQ(lobes_of(DielectricMaterial{.roughness = rough(0.1f, 0.1f)}),
              (Lobes{.glossy_reflection = true, .glossy_transmission = true}));
    EXPECT_EQ(lobes_of(ThinDielectricMaterial{}), (Lobes{.delta_reflection = true, .delta_transmission = true}));
    EXPECT_EQ(lobes_of(PlasticMaterial{}), (Lobes{.diffuse = true, .delta_reflection = true}));
    EXPECT_EQ(lobes_of(PlasticMaterial{.roughness = rough(0.1f, 0.1f)}),
              (Lobes{.diffuse = true, .glossy_reflection = true}));
    EXPECT_EQ(lobes_of(NullMaterial{}), (Lobes{.null = true}));
}

TEST(MaterialTraits, ABlendAndATwosidedOneHaveWhatTheirPartsHave) {
    Scene scene;
    const std::int32_t metal = add(scene, ConductorMaterial{.roughness = rough(0.1f, 0.3f)});
    const std::int32_t paint = add(scene, DiffuseMaterial{});
    scene.materials.back().detail.bump = 0;
    scene.materials.back().opacity = 0.5f;
    const std::int32_t blend = add(scene, BlendMaterial{{0.5f, 0}, metal, paint});
    const std::int32_t both = add(scene, DiffuseMaterial{});
    scene.materials.back().twosided = true;
    scene.materials.back().back = blend;
    const MaterialTraits traits = material_traits(scene, both);
    EXPECT_EQ(traits.lobes, (Lobes{.diffuse = true, .glossy_reflection = true}));
    EXPECT_TRUE(traits.textured && traits.bumped && traits.anisotropic && traits.blended && traits.microfacets);
    EXPECT_TRUE(traits.twosided && traits.own_back);
    EXPECT_FALSE(traits.masked) << "opacity is the shape's own material's";
    EXPECT_FALSE(material_traits(scene, metal).textured);
    EXPECT_FALSE(material_traits(scene, metal).lobes.diffuse);
}

TEST(MaterialTraits, CountWhatShapesUseAndNothingElse) {
    Scene scene;
    add(scene, DielectricMaterial{});
    use(scene, add(scene, DiffuseMaterial{}));
    EXPECT_EQ(scene_traits(scene).lobes, (Lobes{.diffuse = true}));
    EXPECT_TRUE(is_plainly_diffuse(scene));
    EXPECT_EQ(used_materials(scene), (std::vector<bool>{false, true}));
    use(scene, 0);
    EXPECT_TRUE(scene_traits(scene).lobes.delta_transmission);
    EXPECT_FALSE(is_plainly_diffuse(scene));
}

TEST(MaterialTraits, TheCheapKernelNeedsPlainDiffuse) {
    const auto plain = [](const auto& change) {
        Scene scene;
        const std::int32_t other = add(scene, DiffuseMaterial{});
        const std::int32_t material = add(scene, DiffuseMaterial{});
        change(scene.materials.back(), other);
        use(scene, material);
        return is_plainly_diffuse(scene);
    };
    EXPECT_TRUE(plain([](Material&, std::int32_t) {}));
    EXPECT_TRUE(plain([](Material& m, std::int32_t) { m.twosided = true; }));
    EXPECT_TRUE(plain([](Material& m, std::int32_t) { m.opacity = {1.0f, 0}; }));
    EXPECT_FALSE(plain([](Material& m, std::int32_t) { m.bsdf = DiffuseMaterial{{Rgb(1.0f), 0}}; }));
    EXPECT_FALSE(plain([](Material& m, std::int32_t) { m.detail.bump = 0; }));
    EXPECT_FALSE(plain([](Material& m, std::int32_t) { m.detail.normal_map = 0; }));
    EXPECT_FALSE(plain([](Material& m, std::int32_t) { m.bsdf = PlasticMaterial{}; }));
    EXPECT_FALSE(plain([](Material& m, std::int32_t) { m.bsdf = NullMaterial{}; }));
    EXPECT_FALSE(plain([](Material& m, std::int32_t other) {
        m.twosided = true;
        m.back = other;
    }));
    EXPECT_TRUE(is_plainly_diffuse(Scene{}));
}

}  // namespace
}  // namespace treefarm
