// SPDX-License-Identifier: Apache-2.0
#include "common/decide/guiding/guiding_decision.h"

namespace treefarm {

void GuidingDecision::judge(const JudgedPass& pass, const Evidence& sums, Memory& memory, Figures& figures) {
    const PassPlan& plan = pass.plan;
    if (pass.rules.guiding && plan.layers.estimates && (!plan.guided || plan.record)) {
        const GuidingVerdict judged =
            plan.guided
                ? memory.passes.after_guided(
                      plan, guiding_evidence(sums, pass.pixels, pass.told, pass.width, pass.sample_cost))
                : memory.passes.after_unguided(plan, mean_variance(pass.pixels, pass.told, pass.width), memory.verdict);
        memory.verdict = judged.guiding;
        figures.efficiency = judged.efficiency;
    }
    figures.guiding = memory.verdict;
}

void GuidingDecision::apply(PassPlan& plan, const Memory& memory) {
    if (memory.verdict != Guiding::loses) return;
    plan.guided = plan.record = plan.learn_mixture = false;
    plan.last_tree = true;
}

}  // namespace treefarm
