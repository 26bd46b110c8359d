// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "worker/lights/environment_batch.h"
#include "worker/lights/flat_lights.h"
#include "worker/lights/sphere_batch.h"

namespace treefarm {

/// Which emitters the vertices of a step sample, chosen before any of them is sampled, so that directions of an
/// environment map and points of spheres are drawn together: Emitters::choose() for each, then Emitters::draw().
struct LightBatch {
    /// Instead of a number: nothing was drawn yet.
    static constexpr std::uint8_t kAlone = 0xff;

    std::array<LightPick, kDrawBatch> chosen;        ///< of each lane
    std::array<LightReceiver, kDrawBatch> receiver;  ///< the place that it is chosen for
    std::array<std::uint8_t, kDrawBatch> number;     ///< in the batch of its kind
    EnvironmentBatch map;
    SphereBatch<sample_by_cone> cones;
    SphereBatch<sample_by_area> spheres;
    std::array<bool, kDrawBatch> by_cone;  ///< which of the two, where it is a sphere

    void clear() {
        map.clear();
        cones.clear();
        spheres.clear();
    }
};

}  // namespace treefarm
