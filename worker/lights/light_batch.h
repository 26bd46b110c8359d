// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "worker/lights/environment_batch.h"
#include "worker/lights/light_clusters.h"
#include "worker/lights/sphere_batch.h"

namespace treefarm {

/// An emitter that next event has chosen.
struct ChosenEmitter {
    std::uint32_t entry;  ///< of the table that they are chosen by
    LightClusters::Choice cluster;
};

/// Which emitters the vertices of a step sample, chosen before any of them is sampled, so that directions of an
/// environment map and points of spheres are drawn together: Emitters::choose() for each, then Emitters::draw().
struct LightBatch {
    /// Instead of a number: nothing was drawn yet.
    static constexpr std::uint8_t kAlone = 0xff;

    std::array<ChosenEmitter, kDrawBatch> chosen;  ///< of each lane
    std::array<std::uint8_t, kDrawBatch> number;   ///< in the batch of its kind
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
