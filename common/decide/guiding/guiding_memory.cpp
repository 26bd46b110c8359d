// SPDX-License-Identifier: Apache-2.0
#include "common/decide/guiding/guiding_memory.h"

#include <algorithm>
#include <cmath>

#include "common/decide/guiding/guiding_constants.h"

namespace treefarm {

GuidingVerdict GuidingMemory::after_guided(const PassPlan& pass, const GuidingEvidence& evidence) {
    const GuidingEfficiency own = evidence.efficiency();
    const bool counts =
        own.efficiency > 0 && pass.spp >= tuned<policy::kGuiding, std::uint32_t>("guiding.least_judged_spp");
    const GuidingEfficiency efficiency = counts ? efficiency_with(pass, evidence, own) : own;
    const Guiding verdict = judge_guiding(pass, efficiency, before_, std::min(mistrust_, noisier()));
    if (counts) before_ = efficiency;
    mistrust_ = std::sqrt(mistrust_);
    if (verdict == Guiding::loses) first_to_take_up_ = pass.index + 2;  // the first unguided pass alone proves nothing
    return {verdict, efficiency};
}

GuidingEfficiency GuidingMemory::efficiency_with(const PassPlan& pass, const GuidingEvidence& evidence,
                                                 const GuidingEfficiency& own) {
    // In short passes, noise is relative to the light level of an image of few samples.
    if (pass.spp >= tuned<policy::kGuiding, std::uint32_t>("guiding.least_settled_spp") &&
        told_.samples < tuned<policy::kGuiding, std::uint32_t>("guiding.least_settled_spp"))
        told_ = {};
    told_.add(evidence);
    // Passes that each have too few samples may suffice together, and one may have missed light that others found.
    const GuidingEfficiency all = told_.efficiency();
    const bool knows_less =
        own.known < tuned<policy::kGuiding>("guiding.least_known") ||
        all.unguided_variance > tuned<policy::kGuiding>("guiding.mistrusted") * own.unguided_variance;
    return knows_less && all.known >= tuned<policy::kGuiding>("guiding.least_known") ? all : own;
}

GuidingVerdict GuidingMemory::after_unguided(const PassPlan& pass, double variance, Guiding now) {
    if (!(before_.efficiency > 0 && variance > 0)) return {now, before_};
    unguided_samples_ += pass.spp;
    unguided_variance_ += (variance - unguided_variance_) * pass.spp / unguided_samples_;
    const double factor = noisier();
    if (pass.index < first_to_take_up_ || factor == 1 ||
        factor * before_.efficiency <= tuned<policy::kGuiding>("guiding.taking_up"))
        return {now, before_};
    mistrust_ = factor;
    return {Guiding::open, before_};
}

double GuidingMemory::noisier() const {
    const double told = told_.efficiency().unguided_variance;
    const double ratio = told > 0 && unguided_samples_ > 0 ? unguided_variance_ / told : 1.0;
    return ratio > tuned<policy::kGuiding>("guiding.mistrusted") ? ratio : 1.0;
}

}  // namespace treefarm
