// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/base/error.h"
#include "common/decide/next_event/next_event_choice.h"
#include "common/decide/next_event/next_event_constants.h"
#include "common/decide/pass/judged_pass.h"
#include "common/decide/pass/pass_figure.h"
#include "common/decide/pixels/level_constants.h"

namespace treefarm {

/// Decision how often next event samples an emitter in unguided passes. In guided ones each region decides, by the
/// price that is measured here (common/guiding/regions/next_event.h).
struct NextEventDecision {
    using Evidence = NextEventSums;

    struct Memory {
        ImageNextEventLearner learner;
        std::uint8_t code = 0;  ///< in kNextEventSamples, for passes without regions

        template <class Archive>
        void serialize(Archive& archive) {
            archive(learner, code);
            if (Archive::is_loading::value && code >= kNextEventSamples.size())
                throw FormatError("an unknown number of light samples");
        }
    };

    struct Figures {
        NextEventPrice price;  ///< of a pass just finished; not archived
        NextEventVerdict verdict;
        double samples = 1;  ///< light samples per vertex at which emitters may be sampled

        template <class Archive>
        void serialize(Archive& archive) {
            archive(verdict.saved, verdict.low, samples);
        }
    };

    static constexpr std::span<const policy::Constant> kConstants[] = {policy::kNextEvent, policy::kLevels};
    static constexpr bool kScheduled = false;
    static void judge(const JudgedPass& pass, const Evidence& sums, Memory& memory, Figures& figures);
    /// Nothing: workers are told the code with the model (ImageFacts), beside those of regions.
    static void apply(PassPlan&, const Memory&) {}

    static constexpr DecisionColumn<Figures> kColumns[] = {
        {{"next_event_low", "fraction", kAll, "vertices that have a light sample at 1 in 16 only"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.verdict.low; }},
        {{"next_event_work_ratio", "ratio", kAll, "work over that with a light sample at each vertex",
          "next_event_saved"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.verdict.saved; }},
    };
};

}  // namespace treefarm
