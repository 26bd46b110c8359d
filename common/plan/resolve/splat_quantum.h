// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/scene/model/scene.h"

namespace treefarm {

/// Exponent of the quantum in which a scene's splats are summed (common/film/splat_film.h).
///
/// What one light path brings to the film does not depend on how much of the light gets there: it is about the power of
/// all emitters, scattered once, times the camera's importance at the distance of the scene; where that of the emitters
/// is over 16 times as much, since they are near the lens, a sixteenth of it. The quantum is 2^-20 of that: splats that
/// are a thousand times less are still summed to a thousandth, and those a million times more as well. What is beyond
/// is capped and counted. 0 for a scene without light.
std::int16_t usual_splat_exponent(const Scene& scene);

}  // namespace treefarm
