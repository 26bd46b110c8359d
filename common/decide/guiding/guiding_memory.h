// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/decide/guiding/guiding_efficiency.h"
#include "common/decide/guiding/guiding_verdict.h"
#include "common/decide/pass/pass_plan.h"

namespace treefarm {

/// Verdict on guiding after a pass, with the efficiency that it is based on; zeros if unknown.
struct GuidingVerdict {
    Guiding guiding = Guiding::open;
    GuidingEfficiency efficiency{};

    template <class Archive>
    void serialize(Archive& archive) {
        archive(guiding, efficiency);
        if (Archive::is_loading::value) require_known(guiding);
    }
};

/// Evidence on guiding from a render's passes, which decides whether the next ones are guided. Guided passes estimate
/// the variance of unguided ones; if unguided passes were in fact noisier than estimated, that counts more.
class GuidingMemory {
  public:
    /// Verdict after a guided pass that recorded.
    GuidingVerdict after_guided(const PassPlan& pass, const GuidingEvidence& evidence);
    /// Verdict after an unguided pass; `variance`: of a sample, as GuidingEfficiency::unguided_variance; 0: unknown.
    /// Returns `now` if the pass adds no evidence.
    GuidingVerdict after_unguided(const PassPlan& pass, double variance, Guiding now);

    bool operator==(const GuidingMemory&) const = default;

    template <class Archive>
    void serialize(Archive& archive) {
        archive(before_, told_, unguided_samples_, unguided_variance_, mistrust_, first_to_take_up_);
    }

  private:
    /// Guiding efficiency after a pass with the result `own`; adds its evidence to that of all passes.
    GuidingEfficiency efficiency_with(const PassPlan& pass, const GuidingEvidence& evidence,
                                      const GuidingEfficiency& own);
    /// Variance of unguided passes over the guided ones' estimate of it; 1 if unknown, or not significant.
    double noisier() const;

    GuidingEfficiency before_;            ///< efficiency at the last verdict
    GuidingEvidence told_;                ///< evidence of the guided passes so far
    double unguided_samples_ = 0;         ///< samples of each pixel
    double unguided_variance_ = 0;        ///< variance of those samples, measured in unguided passes
    double mistrust_ = 1;                 ///< noisier() when guiding was resumed; fades with each guided pass
    std::uint32_t first_to_take_up_ = 0;  ///< number of the first pass that may resume guiding
};

}  // namespace treefarm
