// SPDX-License-Identifier: Apache-2.0
#include "common/decide/splitting/splitting_decision.h"

namespace treefarm {

void SplittingDecision::judge(const JudgedPass& pass, const Evidence& sums, Memory& memory, Figures& figures) {
    figures.gain = splitting_gain(sums, pass.counts);
    if (pass.rules.splitting && !splitting_may_pay(pass.plan, figures.gain)) memory.pays = false;
    figures.pays = memory.pays;
}

void SplittingDecision::apply(PassPlan& plan, const Memory& memory) {
    if (!memory.pays) plan.split = false;
}

}  // namespace treefarm
