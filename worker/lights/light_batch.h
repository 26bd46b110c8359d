// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "worker/lights/environment_batch.h"
#include "worker/lights/flat_lights.h"
#include "worker/lights/sphere_batch.h"

namespace treefarm {

/// Emitters sampled at the vertices of a step, all chosen before any is sampled, so that directions of an environment
/// map and points of spheres are drawn together: Emitters::choose() for each, then Emitters::draw().
struct LightBatch {
    /// Value of `number` for an emitter that has no batch.
    static constexpr std::uint8_t kAlone = 0xff;

    std::array<LightPick, kDrawBatch> chosen;        ///< of each lane
    std::array<LightReceiver, kDrawBatch> receiver;  ///< point for which the lane chooses
    std::array<Draw, kDrawBatch> random;             ///< random numbers of the choice
    FlatBatch flat;                                  ///< batch of choices among few emitters
    std::array<std::uint8_t, kDrawBatch> number;     ///< index in the batch of its kind
    EnvironmentBatch map;
    SphereBatch<sample_by_cone> cones;
    SphereBatch<sample_by_area> spheres;
    std::array<bool, kDrawBatch> by_cone;  ///< for spheres: whether in `cones` rather than `spheres`

    void clear() {
        flat.clear();
        map.clear();
        cones.clear();
        spheres.clear();
    }
};

}  // namespace treefarm
