// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/film/guiding_efficiency.h"
#include "common/plan/schedule.h"

namespace treefarm {

/// Verdict on guiding after a pass, and the worth that it rests on; zeros where nothing is known.
struct GuidingVerdict {
    Guiding guiding;
    GuidingEfficiency efficiency;
};

/// What is remembered of a render's passes to decide whether the next ones are guided. Guided passes say what unguided
/// ones would be like; where those were noisier, they have the last word.
class GuidingMemory {
  public:
    /// Verdict after a guided pass that taught.
    GuidingVerdict after_guided(const PassPlan& pass, const GuidingEvidence& evidence);
    /// Verdict after an unguided pass with such a variance of a sample, as GuidingEfficiency::unguided_variance; 0: not
    /// known. Where it says nothing new, it is `now`.
    GuidingVerdict after_unguided(const PassPlan& pass, double variance, Guiding now);

    bool operator==(const GuidingMemory&) const = default;

    template <class Archive>
    void serialize(Archive& archive) {
        archive(before_, told_, unguided_samples_, unguided_variance_, mistrust_, first_to_take_up_);
    }

  private:
    /// Worth of guiding by a pass that said `own`; adds that to what all have told.
    GuidingEfficiency efficiency_with(const PassPlan& pass, const GuidingEvidence& evidence,
                                      const GuidingEfficiency& own);
    /// How many times as noisy unguided passes have been as guided ones say; 1 where nobody knows, or where it is the
    /// same but for chance.
    double noisier() const;

    GuidingEfficiency before_;            ///< by which guiding was judged last
    GuidingEvidence told_;                ///< by the guided passes so far
    double unguided_samples_ = 0;         ///< of each pixel
    double unguided_variance_ = 0;        ///< of those samples, by themselves
    double mistrust_ = 1;                 ///< noisier() when guiding was taken up; fades with each guided pass
    std::uint32_t first_to_take_up_ = 0;  ///< number of the first pass that may take guiding up again
};

}  // namespace treefarm
