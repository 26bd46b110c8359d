#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/base/error.h"
#include "common/math/vec.h"

namespace treefarm {

/// The scene as plain values: what a reader produces, what is broadcast to workers, what the plan looks at. Indices,
/// never pointers. Positions are in world space. Everything that needs the C library's transcendental functions
/// (rotations, spectra, gamma) is computed here, once, on the coordinator, so that workers cannot differ in it.

inline constexpr std::int32_t kNone = -1;

struct DiffuseMaterial {
    Rgb reflectance{0.5f};  ///< albedo per channel, in [0, 1]
};

/// How a surface scatters. Later effects add alternatives.
struct Material {
    std::variant<DiffuseMaterial> bsdf;
    bool twosided = false;  ///< the same BSDF on both sides; otherwise the back is black
    std::string name;
    Location where;
};

/// An indexed triangle mesh in world space.
struct Mesh {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;           ///< unit shading normals, one per position; empty: use the triangle's own
    std::vector<Vec2> uvs;               ///< one per position; empty: none
    std::vector<std::uint32_t> indices;  ///< three per triangle, counter-clockwise seen from the front

    std::size_t triangle_count() const { return indices.size() / 3; }
};

/// An analytic sphere in world space.
struct Sphere {
    Vec3 center{0.0f};
    float radius = 1.0f;
    bool flip_normals = false;  ///< normals point inwards
};

/// Something that rays can hit. Its place in Scene::shapes is its id everywhere (Embree's geomID, the emitter table).
struct Shape {
    std::variant<Mesh, Sphere> geometry;
    std::int32_t material = kNone;
    std::int32_t emitter = kNone;  ///< index of an area emitter on the front side, or kNone
    std::string name;
    Location where;
};

/// Emits `radiance` from the front of a shape, in every direction of the hemisphere.
struct AreaEmitter {
    Rgb radiance{1.0f};  ///< W / (m^2 sr), per channel
    std::int32_t shape = kNone;
};

/// Emits `radiance` from infinity, in every direction.
struct ConstantEmitter {
    Rgb radiance{1.0f};
};

struct Emitter {
    std::variant<AreaEmitter, ConstantEmitter> kind;
    Location where;
};

/// A pinhole camera. The pixel (x, y) (y down) at film position (sx, sy) in [0,1]^2 sees along
/// normalize(corner + sx * across + sy * down).
struct Camera {
    Vec3 origin{0.0f};
    Vec3 corner{0.0f};  ///< direction to the film's upper left corner, not normalised
    Vec3 across{0.0f};  ///< from the left to the right edge of the film
    Vec3 down{0.0f};    ///< from the upper to the lower edge
};

/// The pixel's reconstruction filter, sampled by importance (docs/guiding.md): the sub-pixel offset is drawn from it.
enum class PixelFilter : std::uint8_t { box, tent, gaussian };

struct Film {
    int width = 768;   ///< pixels, 1 to 65535
    int height = 576;  ///< pixels, 1 to 65535
    PixelFilter filter = PixelFilter::box;
    float filter_radius = 0.5f;  ///< pixels; box: half its width
    float filter_stddev = 0.5f;  ///< pixels; gaussian only
};

struct Scene {
    std::vector<Shape> shapes;
    std::vector<Material> materials;
    std::vector<Emitter> emitters;
    Camera camera;
    Film film;

    /// Index of the constant emitter, or kNone.
    std::int32_t environment() const;
    /// Box of all shapes; empty if there are none.
    Box3 bounds() const;
    std::size_t triangle_count() const;
};

}  // namespace treefarm
