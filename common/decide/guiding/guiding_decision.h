// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/base/error.h"
#include "common/decide/guiding/guiding_constants.h"
#include "common/decide/guiding/guiding_memory.h"
#include "common/decide/pass/judged_pass.h"
#include "common/decide/pass/pass_figure.h"

namespace treefarm {

/// Decision whether passes are guided: one for the whole image and not a weight, so that no pixel is biased by its own
/// samples.
struct GuidingDecision {
    using Evidence = UnguidedSums;

    struct Memory {
        GuidingMemory passes;
        Guiding verdict = Guiding::open;

        bool operator==(const Memory&) const = default;

        template <class Archive>
        void serialize(Archive& archive) {
            archive(passes, verdict);
            if (Archive::is_loading::value) require_known(verdict);
        }
    };

    using Figures = GuidingVerdict;

    static constexpr std::span<const policy::Constant> kConstants[] = {policy::kGuiding};
    static constexpr bool kScheduled = true;
    static void judge(const JudgedPass& pass, const Evidence& sums, Memory& memory, Figures& figures);
    /// If guiding loses, a pass is unguided and teaches nothing.
    static void apply(PassPlan& plan, const Memory& memory);

    static constexpr DecisionColumn<Figures> kColumns[] = {
        {{"guided", "0 or 1", kAll, "paths were guided"},
         [](const PassPlan& plan, const Figures&) -> FigureValue { return plan.guided; }},
        {{"guiding_efficiency", "ratio", kAll, "unguided work over guided; 0: not known", "worth guiding_worth"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.efficiency.efficiency; }},
        {{"guiding_efficiency_low", "ratio", kAll, "less one standard error", "worth_low guiding_worth_low"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.efficiency.low(); }},
        {{"guiding_efficiency_high", "ratio", kAll, "plus one standard error", "worth_high guiding_worth_high"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.efficiency.high(); }},
        {{"guiding_efficiency_groups", "count", kInTable, "groups of pixels, of 64, that it rests on", "worth_known"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.efficiency.known; }},
        {{"unguided_variance", "number", kInTable, "variance that an unguided sample would have"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.efficiency.unguided_variance; }},
    };
};

}  // namespace treefarm
