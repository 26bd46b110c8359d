#pragma once

#include <array>
#include <cstdint>

#include "worker/lights/environment_batch.h"
#include "worker/lights/light_clusters.h"

namespace treefarm {

/// An emitter that next event has chosen.
struct ChosenEmitter {
    std::uint32_t entry;  ///< of the table that they are chosen by
    LightClusters::Choice cluster;
};

/// Which emitters the vertices of a step sample, chosen before any of them is looked at, so that directions of an
/// environment map are drawn together: Emitters::choose() for each, then Emitters::draw().
struct LightBatch {
    std::array<ChosenEmitter, kDrawBatch> chosen;  ///< of each lane
    std::array<std::uint8_t, kDrawBatch> number;   ///< in `map`, where it is a part of the environment's
    EnvironmentBatch map;

    void clear() { map.clear(); }
};

}  // namespace treefarm
