// SPDX-License-Identifier: Apache-2.0
#include "common/decide/next_event/next_event_decision.h"

#include "common/decide/next_event/next_event_constants.h"

namespace treefarm {

void NextEventDecision::judge(const JudgedPass& pass, const Evidence& sums, Memory& memory, Figures& figures) {
    const auto asked = static_cast<double>(sums[kNextEventAsked]), drawn = static_cast<double>(sums[kNextEventDrawn]);
    if (asked > 0) figures.samples = drawn / asked;
    if (!pass.measures_noise()) return;
    const PassPlan& plan = pass.plan;
    // Samples along which direct light was counted.
    const std::uint64_t samples =
        multiples_in(plan.first_sample, plan.spp, tuned<policy::kNextEvent, std::uint32_t>("next_event.counted_every"));
    const double paths =
        asked > 0 ? static_cast<double>(pass.counts.paths) * static_cast<double>(samples) / plan.spp : 0;
    figures.price = {
        relative_variance(pass.pixels, pass.levels, pass.width),
        paths > 0 ? pass.sample_cost + tuned<policy::kNextEvent>("next_event.sample_cost") * drawn / paths : 0, paths};
    if (!pass.rules.next_event) return;
    if (!plan.guided)
        figures.verdict = memory.learner.learn(sums, figures.price, memory.code);
    else if (asked > 0 && !pass.next.guided)
        memory.code = next_event_code(drawn / asked);  // guiding was judged at the regions' own rates
}

}  // namespace treefarm
