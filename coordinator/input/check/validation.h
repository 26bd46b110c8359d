// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "common/scene/model/scene.h"
#include "coordinator/input/check/warning.h"

namespace treefarm::validation {

/// Parts of validate_scene(). Each throws InputError at the fault's location.

/// Limit of coordinates: Embree silently skips geometry beyond 1.8e18, and squared distances must stay floats.
inline constexpr float kFarthest = 1e18f;

inline bool is_too_far(const Vec3& v, float margin = 0.0f) {
    return std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z))) + margin > kFarthest;
}

/// Whether a vector has unit length, within the rounding of readers.
inline bool is_unit(const Vec3& v) {
    return std::abs(dot(v, v) - 1.0f) < 1e-3f;
}

/// Checks sizes, and that all values are finite. Returns the range of each image.
std::vector<ValueRange> check_images(const std::vector<TextureImage>& images);

/// Range of each texture's values, from those of the images.
std::vector<ValueRange> check_textures(const Scene& scene, const std::vector<ValueRange>& images);

/// Raises roughness to its minimum and scales textured factors above 1 down, with a warning; in unlimited materials
/// they are kept, also with a warning.
void check_materials(Scene& scene, const std::vector<ValueRange>& textures, std::vector<Warning>& warnings);

/// Whether no triangle has an area (that single precision gives a normal), though all vertices are finite.
bool is_flat(const Mesh& mesh);

/// Removes mesh attributes that no texture needs. Needed ones must exist, with a finite value for each vertex or
/// triangle.
void check_mesh_attributes(Scene& scene);

/// Whether a shape is a mesh without texture coordinates whose material is anisotropic: its highlights then follow the
/// edges of triangles.
bool lacks_tangents(const Scene& scene, const Shape& shape);

/// Removes triangles without area, and names anisotropic meshes without texture coordinates, with warnings.
void check_shapes(Scene& scene, std::vector<Warning>& warnings);

void check_emitters(const Scene& scene, const std::vector<ValueRange>& images, const std::vector<ValueRange>& textures);

}  // namespace treefarm::validation
