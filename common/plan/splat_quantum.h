// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/scene/model/scene.h"

namespace treefarm {

/// Exponent of the quantum in which a scene's splats are summed (common/film/splat_film.h).
///
/// What one light path brings to the film does not depend on how much of the light gets there: it is about the power of
/// all emitters, scattered once, times the camera's importance at the distance of the scene. The quantum is 2^-20 of
/// that, so splats that are a thousand times less, or a million times more, are summed as well. Those beyond are capped
/// and counted; rounding of those below is in the variance. 0 for a scene without light.
std::int16_t usual_splat_exponent(const Scene& scene);

}  // namespace treefarm
