// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/scene/model/scene.h"

namespace treefarm {

/// Exponent of the quantum in which a scene's splats are summed (common/film/splat_film.h).
///
/// The contribution of a light path to the film does not depend on how much light reaches the camera: it is about the
/// power of all emitters, scattered once, times the camera's importance at the distance of the scene. If the importance
/// at the emitters is more than 16 times as large, since they are near the lens, a sixteenth of that is used instead.
/// The quantum is 2^-20 of this value: splats a thousand times smaller are still summed to a thousandth, and splats a
/// million times larger fit. Larger ones are capped and counted. 0 for a scene without light.
std::int16_t usual_splat_exponent(const Scene& scene);

}  // namespace treefarm
