// SPDX-License-Identifier: Apache-2.0
#include "common/guiding/sd_tree/sd_tree.h"

#include "common/base/policy.h"

namespace treefarm {

SdTree initial_tree(const Box3& bounds, const FirstModel& settings) {
    SdTree tree;
    set_cube(tree, bounds);
    tree.nodes.push_back({{0, 0}});
    const std::uint32_t cells = 1u << (2 * tuned<int>("learning.initial_depth"));
    tree.cell_begin = {0};
    for (int distribution = 0; distribution < (settings.with_views ? 2 : 1); ++distribution) {
        tree.cell_depth.insert(tree.cell_depth.end(), cells, tuned<int>("learning.initial_depth"));
        tree.cell_mass.insert(tree.cell_mass.end(), cells,
                              1u << (kMassBits - 2 * tuned<int>("learning.initial_depth")));
        tree.cell_begin.push_back(tree.cell_count());
        tree.quantum_exponent.push_back(quantum_exponent_for(settings.radiance_scale));
        tree.bsdf_fraction.push_back(settings.bsdf_fraction);
    }
    if (settings.with_views) {
        tree.view_set = {0};
        tree.view_begin = {0, 1};
        tree.view_depth = {0};
        tree.view_fraction = {settings.view_fraction};
        if (settings.view_fraction == 0.0f)
            tree.bsdf_fraction.back() = static_cast<float>(tuned("learning.least_bsdf_fraction"));
    }
    if (settings.with_lights) tree.light_probabilities = {{kLightProbabilityOne}};
    return tree;
}

}  // namespace treefarm
