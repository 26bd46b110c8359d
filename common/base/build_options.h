// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Effects that the program can be built without, by naming them in CMake's TREEFARM_WITHOUT (cmake/options.cmake), to
/// measure what they cost where they are off (bench/effect_cost, docs/generated/effects.md). Such a build refuses the
/// scenes that call for them (SceneEffects). All are on by default.
inline constexpr bool kHasTextures = TREEFARM_HAS_TEXTURES;          ///< of materials and area emitters
inline constexpr bool kHasMasks = TREEFARM_HAS_MASKS;                ///< opacity below 1
inline constexpr bool kHasBump = TREEFARM_HAS_BUMP;                  ///< bump and normal maps
inline constexpr bool kHasTransmission = TREEFARM_HAS_TRANSMISSION;  ///< dielectrics: rough, smooth and thin
inline constexpr bool kHasEnvironment = TREEFARM_HAS_ENVIRONMENT;    ///< constant emitters and environment maps
inline constexpr bool kHasLens = TREEFARM_HAS_LENS;                  ///< thin lens

}  // namespace treefarm
