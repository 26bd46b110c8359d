// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "common/scene/model/scene.h"
#include "coordinator/input/check/warning.h"

namespace treefarm::validation {

/// The parts of validate_scene. Each throws InputError at the place of what is wrong.

/// Embree silently leaves out what lies beyond 1.8e18, and squared distances must stay floats.
inline constexpr float kFarthest = 1e18f;

inline bool is_too_far(const Vec3& v, float margin = 0.0f) {
    return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z))) + margin > kFarthest;
}

/// Whether a vector has unit length, as well as readers compute it.
inline bool is_unit(const Vec3& v) {
    return std::abs(dot(v, v) - 1.0f) < 1e-3f;
}

/// Checks sizes and that all values are finite; the range of each.
std::vector<ValueRange> check_images(const std::vector<TextureImage>& images);

/// The range of each texture's values, from those of the images.
std::vector<ValueRange> check_textures(const Scene& scene, const std::vector<ValueRange>& images);

/// Raises roughness below the least to it and scales textured factors above 1 down, with a warning; those of unlimited
/// materials stay, with one, too.
void check_materials(Scene& scene, const std::vector<ValueRange>& textures, std::vector<Warning>& warnings);

/// Whether no triangle has an area (or one too small for single precision to give it a normal), though all vertices are
/// finite.
bool is_flat(const Mesh& mesh);

/// Removes attributes of meshes that no texture asks for; those that one does must be there, one value for each vertex
/// or triangle, and finite.
void check_mesh_attributes(Scene& scene);

/// Leaves out triangles without area, with a warning.
void check_shapes(Scene& scene, std::vector<Warning>& warnings);

void check_emitters(const Scene& scene, const std::vector<ValueRange>& images, const std::vector<ValueRange>& textures);

}  // namespace treefarm::validation
