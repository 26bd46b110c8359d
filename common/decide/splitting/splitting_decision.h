// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/decide/pass/judged_pass.h"
#include "common/decide/pass/pass_figure.h"
#include "common/decide/splitting/splitting_constants.h"
#include "common/decide/splitting/splitting_gain.h"

namespace treefarm {

/// Decision whether paths may split: once splitting was found not to pay, no path is split.
struct SplittingDecision {
    using Evidence = SplittingSums;

    struct Memory {
        bool pays = true;  ///< may pay

        template <class Archive>
        void serialize(Archive& archive) {
            archive(pays);
        }
    };

    struct Figures {
        SplittingGain gain;  ///< of a guided pass that recorded and may split
        bool pays = true;    ///< may pay, after the pass

        template <class Archive>
        void serialize(Archive& archive) {
            archive(gain, pays);
        }
    };

    static constexpr std::span<const policy::Constant> kConstants[] = {policy::kSplitting};
    static constexpr bool kScheduled = true;
    static void judge(const JudgedPass& pass, const Evidence& sums, Memory& memory, Figures& figures);
    static void apply(PassPlan& plan, const Memory& memory);

    static constexpr DecisionColumn<Figures> kColumns[] = {
        {{"split", "0 or 1", kAll, "paths were split"},
         [](const PassPlan& plan, const Figures&) -> FigureValue { return plan.split; }},
        {{"splitting_variance_ratio", "ratio", kAll, "variance of unsplit samples over that of split ones",
          "splitting_quietens"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.gain.variance; }},
        {{"splitting_ray_ratio", "ratio", kAll, "rays of split samples over those of unsplit ones", "splitting_rays"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.gain.rays; }},
        {{"splitting_mean_ratio", "ratio", kAll, "mean of unsplit samples over that of split ones", "splitting_found"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.gain.mean_ratio; }},
    };
};

}  // namespace treefarm
