// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// A point of a mesh that TextureSet::arranged() has seen; barycentrics of the second and third vertex.
struct MeshPoint {
    const Mesh* mesh = nullptr;
    std::uint32_t triangle = 0;
    float b1 = 0, b2 = 0;
};

/// Where a texture is looked up.
struct TexturePoint {
    Vec2 uv{0.0f};
    const MeshPoint* on_mesh = nullptr;  ///< where TextureSet::reads_meshes(), on a mesh

    TexturePoint() = default;
    TexturePoint(float u, float v) : uv(u, v) {}
    TexturePoint(const Vec2& coordinates, const MeshPoint* point = nullptr) : uv(coordinates), on_mesh(point) {}
};

/// Where a texture finds the attribute that it is made of.
struct AttributeSlot {
    std::uint32_t index = 0;  ///< in Mesh::attributes
    bool of_faces = false;
};

/// The textures of a scene, ready to be looked up. Immutable; any number of threads may ask.
class TextureSet {
  public:
    TextureSet() = default;
    TextureSet(std::vector<Texture> textures, std::vector<TextureImage> images);

    /// The shapes, with the attributes of each mesh where color() looks for them: it does not go by their names. A mesh
    /// with attributes gets an empty one for each of the textures' names that it has none of.
    std::vector<Shape> arranged(std::vector<Shape> shapes) const;

    /// Linear value of a texture at a point.
    Rgb color(std::int32_t texture, const TexturePoint& at) const;
    /// Fetches most of what color() reads.
    void prefetch(std::int32_t texture, const Vec2& uv) const;
    /// Mean of the channels of color().
    float value(std::int32_t texture, const TexturePoint& at) const { return average(color(texture, at)); }
    /// How the value changes with u and v: of an image, by central differences over half a texel to each side.
    Vec2 gradient(std::int32_t texture, const TexturePoint& at) const;

    Rgb eval(const ColorInput& input, const TexturePoint& at) const {
        return input.varies() ? input.value * color(input.texture, at) : input.value;
    }
    float eval(const FloatInput& input, const TexturePoint& at) const {
        return input.varies() ? input.value * value(input.texture, at) : input.value;
    }

    /// Whether some are made of attributes of meshes: only then points must say on_mesh.
    bool reads_meshes() const { return reads_meshes_; }

    const std::vector<Texture>& textures() const { return textures_; }
    const std::vector<TextureImage>& images() const { return images_; }
    /// Bytes that pixels take.
    std::size_t memory() const;

  private:
    std::vector<Texture> textures_;
    std::vector<TextureImage> images_;
    std::vector<AttributeSlot> slots_;          ///< per texture; empty unless some are made of attributes of meshes
    std::vector<std::string> attribute_names_;  ///< per place in Mesh::attributes
    bool reads_meshes_ = false;
};

/// Texel (x, y) of an image, x and y in range; single-channel images are grey.
Rgb texel(const TextureImage& image, int x, int y);
/// Fetches the texel (x, y).
void prefetch_texel(const TextureImage& image, int x, int y);

}  // namespace treefarm
