// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/film/aov_film.h"
#include "common/film/combine.h"
#include "common/guiding/any_guide.h"
#include "common/guiding/regions/next_event.h"
#include "common/plan/budget.h"
#include "coordinator/guiding_memory.h"
#include "coordinator/partial_pass.h"
#include "coordinator/pass_report.h"

namespace treefarm {

/// A render between two passes, or within one, as a value: whatever decides a later bit, and the reports of the passes
/// so far. Nothing else outlives a pass, so who has it can go on, here or elsewhere, as if nothing had happened
/// (docs/design/checkpoint.md).
struct RenderState {
    RenderHistory history;
    std::vector<PassResult> films;  ///< that make the image, folded
    AovSums aovs;
    GuidingMemory guiding_memory;
    AnyModel tree;                  ///< guides the next pass
    std::optional<bool> last_tree;  ///< whether it was refined as the last one; nothing: it is the first
    AnyLearner learner;
    ImageNextEventLearner image_next_event;
    std::vector<PassReport> reports;     ///< of finished passes
    std::uint64_t tree_hash = 0;         ///< of the encoded tree that guided the last of them
    std::optional<PartialPass> partial;  ///< the pass after them, as far as it is, where the state goes on within it

    std::uint32_t spp() const { return history.spp(); }
    /// The passes that are finished, and the one that is begun.
    std::vector<PassPlan> plans() const;
};

/// The state before any pass; `tree`: the first one.
RenderState first_state(const Resolved& job, AnyModel tree, std::size_t pixels);

/// What a pass brought.
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

// The steps from a state to the next, in this order. Each is pure but for the state that it changes.

/// Adds the pass's film to the others.
void add_film(RenderState& state, const Resolved& job, CollectedPass pass);
/// Combines the films; measures their noise where that is not known yet.
void combine_films(RenderState& state, const Resolved& job, DevelopedState& developed);
/// The other figures of the combined image, the last pass's variance among them, in threads of their own.
void describe_image(const RenderState& state, const Resolved& job, DevelopedState& developed, PassVariance& last_pass);
/// Verdicts on guiding, splitting, light subpaths and, where nothing guides, next event, by the pass's figures and the
/// image with it. Sets the report's.
void judge(RenderState& state, const Resolved& job, const CombinedImage& image, std::size_t width, PassReport& report);
/// The tree of the coming pass, by what the pass recorded. Without a coming one, as for a pass that goes on doubling:
/// whoever continues an ended render needs it.
void learn(RenderState& state, const Resolved& job, const PassPlan& pass, const std::optional<PassPlan>& coming,
           const CellSums& sums, const NextEventPrice& price, RefineReport& report);

}  // namespace treefarm
