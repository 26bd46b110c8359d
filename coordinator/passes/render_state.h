// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/film/aov_film.h"
#include "common/film/combine.h"
#include "common/guiding/any_guide.h"
#include "common/plan/forecast/budget.h"
#include "coordinator/farm/partial_pass.h"
#include "coordinator/passes/pass_report.h"

namespace treefarm {

/// State of a render between two passes, or within one, as a value: all that decides later bits, and the reports of the
/// passes so far. Nothing else outlives a pass, so that a copy can be resumed here or elsewhere with the same result
/// (docs/design/checkpoint.md).
struct RenderState {
    RenderHistory history;
    std::vector<PassResult> films;  ///< summed up to the films that the image consists of
    AovSums aovs;
    AnyModel tree;                  ///< guides the next pass
    std::optional<bool> last_tree;  ///< whether it was refined as the last one; no value: it is the first
    AnyLearner learner;
    std::vector<PassReport> reports;     ///< of finished passes
    std::uint64_t tree_hash = 0;         ///< of the encoded tree that guided the last finished pass
    std::optional<PartialPass> partial;  ///< the partial pass after them, if the state is within one

    std::uint32_t spp() const { return history.spp(); }
    /// Plans of the finished passes and of the partial one.
    std::vector<PassPlan> plans() const;
};

/// State before any pass; `tree`: the first tree.
RenderState first_state(const Resolved& job, AnyModel tree, std::size_t pixels);

/// Collected results of a pass.
struct CollectedPass {
    PassPlan plan;
    std::vector<PixelEstimate> pixels;
    AovPixels aovs;
    TraceStats stats;
};

/// Image of a state.
struct DevelopedState {
    std::shared_ptr<const CombinedImage> image = std::make_shared<CombinedImage>();
    std::shared_ptr<const std::vector<AovChannel>> aovs = std::make_shared<std::vector<AovChannel>>();
    std::uint64_t image_hash = 0;  ///< of the combined means
    std::uint64_t aov_hash = 0;    ///< of the other layers
    ErrorEstimate error;
};

// Steps from a state to the next, in this order. Each is pure except for the state that it changes.

/// Adds the pass's film to the others.
void add_film(RenderState& state, const Resolved& job, CollectedPass pass);
/// Combines the films, and measures their noise if it is unknown.
void combine_films(RenderState& state, const Resolved& job, DevelopedState& developed);
/// Throws RunError for an image that floats do not hold, or whose error is infinite: it is no result.
void require_finite(const CombinedImage& image, const ErrorEstimate& error);
/// Computes the image's other figures, including the last pass's variance, in parallel threads. Throws as
/// require_finite().
void describe_image(const RenderState& state, const Resolved& job, DevelopedState& developed, PassVariance& last_pass);
/// Judges the pass by its sums and the combined image (common/decide/decisions.h). Sets the verdicts of the report, and
/// the facts that the model carries about the image.
void judge(RenderState& state, const Resolved& job, const CombinedImage& image, std::size_t width,
           const Decisions::Evidence& sums, PassReport& report);
/// Builds the tree of the coming pass from the evidence of the pass's records. Without a coming pass it is built as if
/// passes continued to double: a resume of an ended render needs it.
void learn(RenderState& state, const Resolved& job, const PassPlan& pass, const std::optional<PassPlan>& coming,
           Blocks sums, PassReport& report);

}  // namespace treefarm
