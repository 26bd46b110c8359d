#pragma once

#include <cstdint>
#include <vector>

#include "common/scene/emitter.h"
#include "common/scene/material.h"
#include "common/scene/shape.h"

namespace treefarm {

/// The scene as plain values: what a reader produces, what is broadcast to workers, what the plan looks at. Indices,
/// never pointers. Positions are in world space. Everything that needs the C library's transcendental functions
/// (rotations, spectra, gamma) is computed here, once, on the coordinator, so that workers cannot differ in it.

/// A camera. The film position (sx, sy) in [0,1]^2 (y down) sees through origin + corner + sx * across + sy * down:
/// with a pinhole from the origin, with a lens from origin + a * lens_u + b * lens_v for (a, b) in the unit disk, so
/// that the plane of focus is where those points lie.
struct Camera {
    Vec3 origin{0.0f};
    Vec3 corner{0.0f};                ///< to the film's upper left corner, not normalised
    Vec3 across{0.0f};                ///< from the left to the right edge of the film
    Vec3 down{0.0f};                  ///< from the upper to the lower edge
    Vec3 lens_u{0.0f}, lens_v{0.0f};  ///< half axes of the lens, in scene units; zero: a pinhole

    bool has_lens() const { return lens_u != Vec3(0.0f) || lens_v != Vec3(0.0f); }
};

/// The pixel's reconstruction filter, sampled by importance (docs/guiding.md): the sub-pixel offset is drawn from it.
enum class PixelFilter : std::uint8_t { box, tent, gaussian };

struct Film {
    int width = 768;   ///< pixels, 1 to 65535
    int height = 576;  ///< pixels, 1 to 65535
    PixelFilter filter = PixelFilter::box;
    float filter_radius = 0.5f;  ///< pixels; box: half its width
    float filter_stddev = 0.5f;  ///< pixels; gaussian only

    std::size_t pixel_count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

struct Scene {
    std::vector<Shape> shapes;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<TextureImage> images;
    std::vector<Emitter> emitters;
    std::int32_t group_count = 0;  ///< groups of shapes that instances place
    Camera camera;
    Film film;

    /// Index of the constant or image-based environment, or kNone.
    std::int32_t environment() const;
    /// Box of all shapes in the world, instances included; empty if there are none. Like all that follows indices, only
    /// for scenes that validate_scene or decode_scene has accepted.
    Box3 bounds() const;
    /// Order of magnitude of the radiance that its brightest emitter brings to its surfaces, above 0.
    float radiance_scale() const;
    /// Triangles in memory: those of a group count once.
    std::size_t triangle_count() const;
};

}  // namespace treefarm
