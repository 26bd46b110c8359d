// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/plan/schedule/schedule.h"

namespace treefarm {

/// Fields of a pass's plan, for messages and checkpoints.
template <class Archive>
void serialize(Archive& a, PassPlan& m) {
    a(m.index, m.spp, m.first_sample, m.next_event, m.guided, m.split, m.light_subpaths, m.record, m.last_tree,
      m.record_weight, m.learn_mixture, m.blocks_per_unit, m.chunks, m.kernel.plain_diffuse, m.kernel.guided,
      m.kernel.record, m.kernel.views, m.units.tiles, m.units.light_paths, m.units.first_light_path, m.units.chains,
      m.layers.estimates, m.layers.splats.pixels, m.layers.splats.exponent, m.layers.splats.chains, m.emission);
}

}  // namespace treefarm
