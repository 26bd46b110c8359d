// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/decide/emission/emission_shares.h"
#include "common/decide/pass/judged_pass.h"
#include "common/decide/pass/pass_figure.h"

namespace treefarm {

/// Decision at which emitters light paths start, by the contributions of earlier passes.
struct EmissionDecision {
    using Evidence = EmissionSums;  ///< of a pass
    using Memory = EmissionSums;    ///< of all passes

    struct Figures {
        std::uint64_t emitters = 0;          ///< that light paths may start from, if their choice is learned
        std::uint64_t emitters_of_half = 0;  ///< the smallest number of them that started half of the light paths

        template <class Archive>
        void serialize(Archive& archive) {
            archive(emitters, emitters_of_half);
        }
    };

    static constexpr bool kScheduled = false;
    static void judge(const JudgedPass&, const Evidence& sums, Memory& memory, Figures& figures) {
        memory.add(sums);
        figures = {sums.paths.size(), treefarm::emitters_of_half(sums)};
    }
    static void apply(PassPlan& plan, const Memory& memory) {
        if (plan.light_subpaths) plan.emission = emission_emphasis(memory);
    }

    static constexpr DecisionColumn<Figures> kColumns[] = {
        {{"emitters", "count", kAll, "emitters that light paths may start from, where that is learned"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.emitters; }},
        {{"emitters_of_half", "count", kAll, "the fewest of them that started half of the light paths"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.emitters_of_half; }},
    };
};

}  // namespace treefarm
