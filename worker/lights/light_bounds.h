// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"

namespace treefarm {

/// A cone of directions: those within `half_turns` times pi of the unit `axis`.
struct DirectionCone {
    Vec3 axis{0.0f, 0.0f, 1.0f};
    float half_turns = 0;

    static DirectionCone all() { return {{0.0f, 0.0f, 1.0f}, 1.0f}; }
};

/// Angle between two unit vectors, in half turns.
float half_turns_between(const Vec3& a, const Vec3& b);

/// Cone that contains two others, hardly wider than necessary.
DirectionCone joined(const DirectionCone& a, const DirectionCone& b);

/// Position, directions and amount of the light of one or several emitters: the input of the light tree, and an upper
/// bound of their contribution to a point.
struct LightBounds {
    /// Luminance of the irradiance on a facing surface, W / m^2; for emitters that are not at infinity, times the
    /// squared distance.
    double amount = 0;
    bool at_infinity = false;
    Box3 box;          ///< box of its points; empty at infinity
    float radius = 0;  ///< radius of the ball about the box's centre that contains them
    /// Main directions of emission: normals of a surface; at infinity, directions towards the light.
    DirectionCone cone = DirectionCone::all();
    float falloff = 0.5f;  ///< largest angle beyond the cone that still receives light, in half turns

    /// Bounds of an emitter of unknown directions.
    static LightBounds in_box(const Box3& box, double amount);
    /// Bounds of light from infinity; `amount`: irradiance if all of it is faced.
    static LightBounds from_infinity(const DirectionCone& cone, double amount);
};

/// Bounds of two emitters, both at infinity or both not.
LightBounds joined(const LightBounds& a, const LightBounds& b);

/// Cost of a node in the surface area orientation heuristic (Conty Estevez and Kulla 2018, section 4.2): amount times
/// surface area of the box, at least `least_area`, times the measure of its directions. The area does not count at
/// infinity.
double sampling_cost(const LightBounds& bounds, double least_area);

}  // namespace treefarm
