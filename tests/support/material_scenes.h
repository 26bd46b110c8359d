// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "tests/support/test_scenes.h"
#include "worker/shading/material_set.h"

namespace treefarm::test {

inline std::int32_t add_material(Scene& scene, decltype(Material::bsdf) bsdf, bool twosided = false) {
    Material material;
    material.bsdf = std::move(bsdf);
    material.twosided = twosided;
    scene.materials.push_back(std::move(material));
    return static_cast<std::int32_t>(scene.materials.size()) - 1;
}

inline Roughness rough(Microfacets distribution, float alpha_u, float alpha_v) {
    return {distribution, FloatInput(alpha_u), FloatInput(alpha_v)};
}

/// Adds a texture and returns its index.
inline std::int32_t add_texture(Scene& scene, TextureKind kind, const char* name) {
    // in place: GCC 12 warns about copies of an object that may contain a string
    Texture& texture = scene.textures.emplace_back();
    texture.kind = std::move(kind);
    texture.name = name;
    return static_cast<std::int32_t>(scene.textures.size()) - 1;
}

/// Adds an image of linear floats as a texture and returns its index.
inline std::int32_t add_image_texture(Scene& scene, int width, int height, std::vector<float> rgb) {
    TextureImage image;
    image.width = width;
    image.height = height;
    image.floats = std::move(rgb);
    scene.images.push_back(std::move(image));
    BitmapTexture bitmap;
    bitmap.image = static_cast<std::int32_t>(scene.images.size()) - 1;
    return add_texture(scene, bitmap, "image");
}

inline std::int32_t add_board(Scene& scene, const Rgb& color0, const Rgb& color1) {
    CheckerboardTexture board;
    board.color0 = color0;
    board.color1 = color1;
    return add_texture(scene, board, "board");
}

/// Last material of a scene, on one shape, prepared for tracing.
class PreparedMaterial {
  public:
    explicit PreparedMaterial(Scene scene) {
        add_shape(scene, quad(Vec3(0.0f), Vec3(1, 0, 0), Vec3(0, 1, 0)),
                  static_cast<std::int32_t>(scene.materials.size()) - 1);
        textures_ = std::make_unique<TextureSet>(scene.textures, scene.images);
        set_ = std::make_unique<MaterialSet>(scene, *textures_);
        scratch_ = set_->make_scratch();
    }
    explicit PreparedMaterial(decltype(Material::bsdf) bsdf, bool twosided = false)
        : PreparedMaterial(with(std::move(bsdf), twosided)) {}

    /// BSDF of one side; nullptr: black.
    const Bsdf* side(bool back) const { return set_->side(0, back).bsdf; }
    const Bsdf& front() const { return *side(false); }
    const Bsdf& back() const { return *side(true); }
    bool varies() const { return set_->side(0, false).material != kNone; }
    bool needs_tangents() const { return set_->needs_tangents(set_->side(0, false).material); }
    const Bsdf& at(const ShadingPoint& point, bool back = false) {
        return *set_->look_up(set_->side(0, back).material, back, point, scratch_);
    }

  private:
    static Scene with(decltype(Material::bsdf) bsdf, bool twosided) {
        Scene scene;
        add_material(scene, std::move(bsdf), twosided);
        return scene;
    }

    std::unique_ptr<TextureSet> textures_;
    std::unique_ptr<MaterialSet> set_;
    BsdfScratch scratch_;
};

/// A room with a metal floor, a glass sphere, a plastic box and a lamp: non-diffuse light for guides.
inline Scene glossy_room() {
    Scene scene;
    const std::int32_t white = add_diffuse(scene, Rgb(0.6f)), red = add_diffuse(scene, {0.6f, 0.2f, 0.1f});
    const std::int32_t metal = add_material(
        scene,
        ConductorMaterial{{0.2f, 0.9f, 1.1f}, {3.9f, 2.5f, 2.4f}, Rgb(0.9f), rough(Microfacets::ggx, 0.2f, 0.2f)});
    const std::int32_t glass = add_material(scene, DielectricMaterial{1.5f, Rgb(1.0f), Rgb(0.9f), {}});
    const std::int32_t frosted =
        add_material(scene, DielectricMaterial{1.5f, Rgb(1.0f), Rgb(1.0f), rough(Microfacets::ggx, 0.3f, 0.3f)});
    const std::int32_t plastic =
        add_material(scene, PlasticMaterial{1.5f, Rgb(0.1f, 0.3f, 0.5f), Rgb(1.0f), true, {}}, true);
    const std::int32_t rough_plastic = add_material(
        scene, PlasticMaterial{1.5f, Rgb(0.5f, 0.2f, 0.1f), Rgb(1.0f), false, rough(Microfacets::beckmann, 0.2f, 0.2f)},
        true);
    const std::int32_t mixed = add_material(scene, BlendMaterial{FloatInput(0.3f), plastic, glass});
    const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    add_shape(scene, quad(Vec3(0.0f), z, x), metal, Rgb(0.0f), "floor");
    add_shape(scene, quad(y, x, z), white, Rgb(0.0f), "ceiling");
    add_shape(scene, quad(z, y, x), rough_plastic, Rgb(0.0f), "back");
    add_shape(scene, quad(x, z, y), red, Rgb(0.0f), "left");
    add_shape(scene, quad(Vec3(0.0f), y, z), white, Rgb(0.0f), "right");
    add_shape(scene, box({0.1f, 0.0f, 0.5f}, {0.35f, 0.5f, 0.8f}, false), plastic, Rgb(0.0f), "box");
    add_shape(scene, Sphere{{0.7f, 0.2f, 0.35f}, 0.18f}, frosted, Rgb(0.0f), "frosted ball");
    add_shape(scene, quad({0.35f, 0.05f, 0.55f}, {0.35f, 0, 0}, {0, 0.6f, 0}), mixed, Rgb(0.0f), "pane");
    add_shape(scene, quad({0.35f, 0.97f, 0.35f}, x * 0.3f, z * 0.3f), white, Rgb(14.0f, 12.0f, 10.0f), "lamp");
    scene.camera = look_at({0.5f, 0.5f, -1.4f}, {0.5f, 0.5f, 0.0f}, y, 0.357f);
    set_film(scene, 32, 32);
    return scene;
}

}  // namespace treefarm::test
