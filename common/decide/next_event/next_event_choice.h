// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "common/decide/next_event/next_event_sums.h"

namespace treefarm {

/// Choice of the number n of light samples per vertex, from kNextEventSamples, for each region, or for a whole image
/// without guiding (docs/design/guiding.md, "How often next event samples an emitter").

/// Factor by which evidence of emitters, next event, mixtures and visits loses weight with each pass, since evidence of
/// a coarser model is out of date.
inline constexpr double kKeptEvidence = 0.5;

/// Noise and cost of a pass, by which a decision on next event weighs noise against rays.
struct NextEventPrice {
    double variance = 0;  ///< of a camera sample, relative to the squared light level of its block
    double rays = 0;      ///< closest-hit rays per camera sample; 0: no decision
    double paths = 0;     ///< camera samples of the pass
};

/// Result of a decision on next event: predicted variance times cost relative to one sample at every vertex, and how
/// often emitters are sampled.
struct NextEventVerdict {
    double saved = 1;  ///< 1 without a decision
    double low = 0;    ///< share of vertices with the least samples
};

/// Sums of several passes; the weight of older ones halves with each pass.
using NextEventEvidence = std::array<double, kNextEventSums>;

/// Whether later trees will learn more about the light that light samples find.
enum class TreesLearn {
    nothing,  ///< no guide
    no_more,  ///< the tree of the next pass is the last
    on,
};

/// Adds the sums of a pass to evidence of earlier ones, which it halves.
void add_halved(NextEventEvidence& evidence, std::span<const std::uint64_t> fresh);

/// Sets `codes` (indices of kNextEventSamples) of regions so that variance times cost becomes least according to the
/// evidence, from `paths` camera samples. Fewer light samples must win by next_event.standard_errors (policy.h); they
/// are credited with next_event.learned as far as later trees learn the light that the others found, since the evidence
/// is of trees that may not know it yet. On entry `codes` holds the codes of the pass that gathered the last evidence.
/// Pure.
NextEventVerdict decide_next_event(std::span<const NextEventEvidence> evidence, double paths,
                                   const NextEventPrice& price, TreesLearn trees, std::span<std::uint8_t> codes);

/// Learner of the number of light samples of an image without guiding.
class ImageNextEventLearner {
  public:
    /// Turns the code of a pass with these sums into that of the next.
    NextEventVerdict learn(const NextEventSums& sums, const NextEventPrice& price, std::uint8_t& code);

    /// Archives the state, for a checkpoint.
    template <class Archive>
    void serialize(Archive& archive) {
        archive(evidence_, paths_);
    }

  private:
    NextEventEvidence evidence_{};
    double paths_ = 0;
};

}  // namespace treefarm
