// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/image/crop_window.h"
#include "common/math/elementary.h"
#include "common/scene/model/emitter.h"
#include "common/scene/model/material.h"
#include "common/scene/model/shape.h"
#include "common/scene/model/texture.h"

namespace treefarm {

/// The scene as plain values: produced by a reader, broadcast to workers, examined by the plan. It has indices, never
/// pointers. Positions are in world space. Values that need the C library's transcendental functions (rotations,
/// spectra, gamma) are computed once, on the coordinator, so that workers cannot differ in them.

/// A camera. The film position (sx, sy) in [0,1]^2 (y down) sees through origin + corner + sx * across + sy * down: a
/// pinhole camera from the origin, one with a lens from origin + a * lens_u + b * lens_v for (a, b) in the unit disk;
/// these points form the plane of focus. An orthographic camera sees from these points along one direction.
struct Camera {
    Vec3 origin{0.0f};
    Vec3 corner{0.0f};                ///< vector to the film's upper left corner, not normalised
    Vec3 across{0.0f};                ///< vector from the left to the right edge of the film
    Vec3 down{0.0f};                  ///< vector from the upper to the lower edge
    Vec3 lens_u{0.0f}, lens_v{0.0f};  ///< half axes of the lens, in scene units; zero: a pinhole
    Vec3 parallel{0.0f};              ///< orthographic: direction of all rays, of length 1; zero: perspective
    /// Panorama: all directions, by longitude across and latitude down; `across`, `down` and `corner` are orthogonal,
    /// of length 1, and point to the left, upwards and forwards.
    bool panoramic = false;
    /// Whether hidden area emitters (integrator.hide_emitters) let camera rays pass, as Mitsuba 2 and 3 have it; if
    /// not, they are black.
    bool passes_hidden_emitters = false;

    /// Direction of length 1 for the film position (u, v) in [0, 1]^2 of a panorama, v downwards.
    Vec3 panorama_direction(float u, float v) const {
        const SinCos longitude = sincos_turn(u), latitude = sincos_turn(0.5f * v);
        return across * (longitude.sin * latitude.sin) + down * latitude.cos - corner * (longitude.cos * latitude.sin);
    }

    bool is_orthographic() const { return parallel != Vec3(0.0f); }
    bool has_lens() const { return lens_u != Vec3(0.0f) || lens_v != Vec3(0.0f); }
};

/// Reconstruction filter of the pixels, importance-sampled (docs/design/guiding.md): the sub-pixel offset is drawn from
/// it. The cubic filters and Lanczos' have negative lobes.
enum class PixelFilter : std::uint8_t { box, tent, gaussian, cubic, lanczos };

/// The rendered pixels: of a film, or of a crop window on it. Pixels are counted from the window's corner, but each
/// pixel sees what its position on the whole film sees, and draws the same random numbers.
struct Film {
    int width = 768;   ///< rendered pixels, 1 to 65535
    int height = 576;  ///< rendered pixels, 1 to 65535
    PixelFilter filter = PixelFilter::box;
    float filter_radius = 0.5f;              ///< pixels; box: half its width
    float filter_stddev = 0.5f;              ///< pixels; gaussian only
    float filter_b = 0.0f, filter_c = 0.5f;  ///< cubic only: B and C of Mitchell and Netravali (1988)
    CropWindow crop{};                       ///< position of the crop window

    std::size_t pixel_count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    int whole_width() const { return crop.is_window() ? crop.whole_width : width; }
    int whole_height() const { return crop.is_window() ? crop.whole_height : height; }
    /// Index on the whole film, row by row, of a pixel of the window.
    std::uint32_t key_of(int x, int y) const {
        return static_cast<std::uint32_t>((y + std::int64_t{crop.y}) * whole_width() + x + crop.x);
    }
    /// Whether the window is inside a film of 1 to 65535 pixels a side.
    bool is_crop_valid() const {
        return !crop.is_window() ||
               (crop.x >= 0 && crop.y >= 0 && crop.whole_width <= 65535 && crop.whole_height <= 65535 &&
                crop.x <= crop.whole_width - width && crop.y <= crop.whole_height - height);
    }
    /// Whether the filter has negative lobes: samples then have weights of either sign, and pixels may be negative.
    bool is_signed() const { return filter == PixelFilter::cubic || filter == PixelFilter::lanczos; }
};

struct Scene {
    std::vector<Shape> shapes;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<TextureImage> images;
    std::vector<Emitter> emitters;
    std::int32_t group_count = 0;  ///< groups of shapes, for instances
    Camera camera;
    Film film;

    /// Index of the constant or image-based environment, or kNone.
    std::int32_t environment() const;
    /// Box of all shapes in the world, instances included; empty if there are none. Like all functions that follow
    /// indices, only for scenes that validate_scene() or decode_scene() has accepted.
    Box3 bounds() const;
    /// Order of magnitude of the radiance that the brightest emitter causes on surfaces, above 0.
    float radiance_scale() const;
    /// Number of triangles in memory; those of a group count once.
    std::size_t triangle_count() const;
    /// Range and mean of the values of all mesh attributes of this name, each counted once; 0 to 1, and grey, if there
    /// are none.
    ValueRange range_of_attribute(const std::string& name) const;
    Rgb mean_of_attribute(const std::string& name) const;
};

}  // namespace treefarm
