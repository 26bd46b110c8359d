// SPDX-License-Identifier: Apache-2.0
#include "common/decide/light_subpaths/light_subpath_decision.h"

namespace treefarm {

void drop_light_subpaths(PassPlan& plan) {
    plan.light_subpaths = false;
    plan.layers.splats = {};
}

bool has_light_subpaths(const PassPlan& plan) {
    return plan.light_subpaths && plan.layers.estimates && plan.layers.splats.pixels > 0;
}

void LightSubpathDecision::judge(const JudgedPass& pass, const Evidence& sums, Memory& memory, Figures& figures) {
    if (pass.plan.light_subpaths) {
        memory.sums.add(sums);
        memory.counts.rays += pass.counts.rays;
        memory.counts.shadow_rays += pass.counts.shadow_rays;
        figures.gain = light_subpath_gain(memory.sums, memory.counts);
    }
    if (pass.rules.light_subpaths && !light_subpaths_may_pay(pass.plan, figures.gain)) memory.pays = false;
    figures.pays = memory.pays;
}

void LightSubpathDecision::apply(PassPlan& plan, const Memory& memory) {
    if (!memory.pays) drop_light_subpaths(plan);
}

}  // namespace treefarm
