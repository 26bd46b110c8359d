// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/math/vec.h"
#include "common/math/warp.h"

namespace treefarm {

/// Value and density of a BSDF for a pair of directions, without delta lobes.
struct BsdfValue {
    Rgb f_cos{0.0f};  ///< f |cos(wi)|, per steradian
    float pdf = 0;    ///< per steradian, of the smooth part of sample()
};

/// A sampled direction; pdf 0 if none was found (black, absorbed, or below the surface).
struct BsdfSample {
    Vec3 wi{0.0f};
    float pdf = 0;    ///< per steradian; of a delta lobe: its probability
    Rgb f_cos{0.0f};  ///< f |cos(wi)|; of a delta lobe: its reflectance or transmittance, so f_cos / pdf is the weight
    bool delta = false;  ///< no density: only BSDF sampling finds this direction
};

/// Random numbers of sample(), uniform in [0, 1).
struct BsdfRandom {
    float lobe = 0;     ///< chooses the lobe
    Vec2 point{0.0f};   ///< a point of the unit square
    Vec3 cosine{0.0f};  ///< the point, warped to a cosine-distributed direction, which most BSDFs use

    BsdfRandom(float lobe, const Vec2& point) : BsdfRandom(lobe, point, square_to_cosine_hemisphere(point)) {}
    /// From a direction that was warped for many paths together.
    BsdfRandom(float lobe, const Vec2& point, const Vec3& cosine) : lobe(lobe), point(point), cosine(cosine) {}
};

/// Kinds of lobes of a BSDF, as bits.
using LobeBits = std::uint8_t;
inline constexpr LobeBits kSmoothLobe = 1;  ///< has a density: next event and guides can use it
inline constexpr LobeBits kDeltaLobe = 2;
inline constexpr LobeBits kTransmittingLobe = 4;  ///< of a dielectric; combined with one of the others
inline constexpr LobeBits kViewLobe =
    8;  ///< smooth, with a distribution that depends on wo: neither delta nor Lambertian
inline constexpr LobeBits kWideLobe = 16;  ///< smooth, and rarely black for a direction on wo's side

/// All directions of a BSDF are unit vectors in the shading frame and point away from the surface: `wo` to where light
/// goes, `wi` to where it comes from. wo is on the side of +z: the other side has a BSDF of its own (MaterialSet).

}  // namespace treefarm
