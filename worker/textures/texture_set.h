// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/scene/model/scene.h"

namespace treefarm {

/// A point of a mesh from TextureSet::arranged(); barycentrics of the second and third vertex.
struct MeshPoint {
    const Mesh* mesh = nullptr;
    std::uint32_t triangle = 0;
    float b1 = 0, b2 = 0;
};

/// Point at which a texture is evaluated.
struct TexturePoint {
    Vec2 uv{0.0f};
    const MeshPoint* on_mesh = nullptr;  ///< set on meshes if TextureSet::reads_meshes()

    TexturePoint() = default;
    TexturePoint(float u, float v) : uv(u, v) {}
    TexturePoint(const Vec2& coordinates, const MeshPoint* point = nullptr) : uv(coordinates), on_mesh(point) {}
};

/// Location of a mesh-attribute texture's values.
struct AttributeSlot {
    std::uint32_t index = 0;  ///< index in Mesh::attributes
    bool of_faces = false;
};

/// Textures of a scene, prepared for evaluation. Immutable and thread-safe.
class TextureSet {
  public:
    TextureSet() = default;
    TextureSet(std::vector<Texture> textures, std::vector<TextureImage> images);

    /// Shapes with each mesh's attributes in the order that color() expects, which uses indices, not names. A mesh with
    /// attributes gets an empty one for each name that it lacks.
    std::vector<Shape> arranged(std::vector<Shape> shapes) const;

    /// Linear value of a texture at a point.
    Rgb color(std::int32_t texture, const TexturePoint& at) const;
    /// Prefetches most of the data that color() reads.
    void prefetch(std::int32_t texture, const Vec2& uv) const;
    /// Mean of the channels of color().
    float value(std::int32_t texture, const TexturePoint& at) const { return average(color(texture, at)); }
    /// Derivative of the value by u and v; of an image by central differences over half a texel to each side.
    Vec2 gradient(std::int32_t texture, const TexturePoint& at) const;

    Rgb eval(const ColorInput& input, const TexturePoint& at) const {
        return input.varies() ? input.value * color(input.texture, at) : input.value;
    }
    float eval(const FloatInput& input, const TexturePoint& at) const {
        return input.varies() ? input.value * value(input.texture, at) : input.value;
    }

    /// Whether any texture reads mesh attributes, which need TexturePoint::on_mesh.
    bool reads_meshes() const { return reads_meshes_; }

    const std::vector<Texture>& textures() const { return textures_; }
    const std::vector<TextureImage>& images() const { return images_; }
    /// Memory of the pixels in bytes.
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
/// Prefetches the texel (x, y).
void prefetch_texel(const TextureImage& image, int x, int y);

}  // namespace treefarm
