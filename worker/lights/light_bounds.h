// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"

namespace treefarm {

/// A cone of directions: those at most `half_turns` times pi from the unit `axis`.
struct DirectionCone {
    Vec3 axis{0.0f, 0.0f, 1.0f};
    float half_turns = 0;

    static DirectionCone all() { return {{0.0f, 0.0f, 1.0f}, 1.0f}; }
};

/// The angle between two unit vectors, in half turns.
float half_turns_between(const Vec3& a, const Vec3& b);

/// A cone that holds two others, hardly wider than it must be.
DirectionCone joined(const DirectionCone& a, const DirectionCone& b);

/// The place, the directions and the amount of light of an emitter, or of several together: what the light tree is
/// built from, and an upper bound of what they bring to a point.
struct LightBounds {
    /// Luminance of the irradiance on a surface that faces it, W / m^2; of an emitter that is not at infinity times the
    /// squared distance.
    double amount = 0;
    bool at_infinity = false;
    Box3 box;          ///< of its points; empty at infinity
    float radius = 0;  ///< of the ball about the box's centre that holds them
    /// Directions into which it shines most: normals of a surface; at infinity those towards it.
    DirectionCone cone = DirectionCone::all();
    float falloff = 0.5f;  ///< how far beyond the cone it shines at all, in half turns

    /// An emitter of which only the place is known.
    static LightBounds in_box(const Box3& box, double amount);
    /// What comes from infinity out of these directions: of the irradiance when all of it is faced.
    static LightBounds from_infinity(const DirectionCone& cone, double amount);
};

/// Bounds of two that are both at infinity, or both not.
LightBounds joined(const LightBounds& a, const LightBounds& b);

/// Cost of a node in the surface area orientation heuristic (Conty Estevez and Kulla 2018, section 4.2): amount times
/// surface area of the box, at least `least_area`, times the measure of its directions. At infinity there is no area.
double sampling_cost(const LightBounds& bounds, double least_area);

}  // namespace treefarm
