// SPDX-License-Identifier: Apache-2.0
#include "coordinator/guiding_memory.h"

#include <algorithm>
#include <cmath>

#include "common/plan/guiding_verdict.h"
#include "common/plan/policy.h"

namespace treefarm {
namespace {

constexpr const Policy::Guiding& kOf = kPolicy.guiding;

}  // namespace

GuidingVerdict GuidingMemory::after_guided(const PassPlan& pass, const GuidingEvidence& evidence) {
    const GuidingEfficiency own = evidence.efficiency();
    const bool counts = own.efficiency > 0 && pass.spp >= kOf.least_judged_spp;
    const GuidingEfficiency efficiency = counts ? efficiency_with(pass, evidence, own) : own;
    const Guiding verdict = judge_guiding(pass, efficiency, before_, std::min(mistrust_, noisier()));
    if (counts) before_ = efficiency;
    mistrust_ = std::sqrt(mistrust_);
    if (verdict == Guiding::loses) first_to_take_up_ = pass.index + 2;  // the first unguided pass alone has no say
    return {verdict, efficiency};
}

GuidingEfficiency GuidingMemory::efficiency_with(const PassPlan& pass, const GuidingEvidence& evidence,
                                                 const GuidingEfficiency& own) {
    // The light that the noise of short passes is relative to is that of an image of few samples.
    if (pass.spp >= kOf.least_settled_spp && told_.samples < kOf.least_settled_spp) told_ = {};
    told_.add(evidence);
    // Passes that each know too little may know enough together, and what one has missed others have met.
    const GuidingEfficiency all = told_.efficiency();
    const bool knows_less =
        own.known < kOf.least_known || all.unguided_variance > kOf.mistrusted * own.unguided_variance;
    return knows_less && all.known >= kOf.least_known ? all : own;
}

GuidingVerdict GuidingMemory::after_unguided(const PassPlan& pass, double variance, Guiding now) {
    if (!(before_.efficiency > 0 && variance > 0)) return {now, before_};
    unguided_samples_ += pass.spp;
    unguided_variance_ += (variance - unguided_variance_) * pass.spp / unguided_samples_;
    const double factor = noisier();
    if (pass.index < first_to_take_up_ || factor == 1 || factor * before_.efficiency <= kOf.taking_up)
        return {now, before_};
    mistrust_ = factor;
    return {Guiding::open, before_};
}

double GuidingMemory::noisier() const {
    const double told = told_.efficiency().unguided_variance;
    const double ratio = told > 0 && unguided_samples_ > 0 ? unguided_variance_ / told : 1.0;
    return ratio > kOf.mistrusted ? ratio : 1.0;
}

}  // namespace treefarm
