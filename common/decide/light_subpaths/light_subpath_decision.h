// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "common/decide/light_subpaths/light_subpath_constants.h"
#include "common/decide/light_subpaths/light_subpath_gain.h"
#include "common/decide/pass/judged_pass.h"
#include "common/decide/pass/pass_figure.h"

namespace treefarm {

/// Changes a pass of an estimator from both ends to one that traces camera paths only, which do not splat.
void drop_light_subpaths(PassPlan& plan);

/// Whether a pass connects light subpaths to camera subpaths.
bool has_light_subpaths(const PassPlan& plan);

/// Decision whether light subpaths are traced: once they were found not to pay, they are dropped.
struct LightSubpathDecision {
    using Evidence = LightSubpathSums;

    /// Sums of all passes with light subpaths: most of the gain is rare light that few samples find, and a single pass
    /// may have found it by one method only.
    struct Memory {
        bool pays = true;  ///< may pay
        LightSubpathSums sums;
        TraceCounts counts;  ///< rays and shadow rays alone

        template <class Archive>
        void serialize(Archive& archive) {
            archive(pays, sums, counts.rays, counts.shadow_rays);
        }
    };

    struct Figures {
        LightSubpathGain gain;  ///< of a pass with the comparison, and those before it
        bool pays = true;       ///< may pay, after the pass

        template <class Archive>
        void serialize(Archive& archive) {
            archive(gain, pays);
        }
    };

    static constexpr std::span<const policy::Constant> kConstants[] = {policy::kLightSubpaths};
    static constexpr bool kScheduled = true;
    static void judge(const JudgedPass& pass, const Evidence& sums, Memory& memory, Figures& figures);
    static void apply(PassPlan& plan, const Memory& memory);

    static constexpr DecisionColumn<Figures> kColumns[] = {
        {{"light_subpaths", "0 or 1", kAll, "light subpaths were traced"},
         [](const PassPlan& plan, const Figures&) -> FigureValue { return has_light_subpaths(plan); }},
        {{"light_subpaths_variance_ratio", "ratio", kAll, "variance without light subpaths over that with them",
          "light_subpaths_quieten"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.gain.noise; }},
        {{"light_subpaths_ray_ratio", "ratio", kAll, "rays with light subpaths over those without",
          "light_subpaths_rays"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.gain.rays; }},
        {{"camera_paths_mean_ratio", "ratio", kAll, "mean without light subpaths over that with them",
          "camera_paths_found"},
         [](const PassPlan&, const Figures& f) -> FigureValue { return f.gain.mean_ratio; }},
    };
};

}  // namespace treefarm
