// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "worker/integrators/path/candidates.h"
#include "worker/integrators/path/path_settings.h"
#include "worker/integrators/path/path_state.h"

namespace treefarm {

/// Directions of a batch of paths in one step. A path draws one direction or, at its first vertices, several, of which
/// it takes one.
template <class G, class Surface, bool kGuided, bool kConverts>
class DirectionChoice {
  public:
    using Path = PathState<G, Surface>;
    using Sampler = typename G::Sampler;

    DirectionChoice(const Sampler& guide, const PathSettings& settings)
        : guide_(guide), candidates_(kGuided ? settings.candidates : 1), candidate_depth_(settings.candidate_depth) {}

    /// Draws the random numbers of a step; Path::lane is a path's index in them.
    void draw_numbers(std::uint64_t seed, const KeyBatch& keys, std::span<const Path> paths,
                      std::span<const std::uint8_t> alive) {
        const auto lanes = static_cast<std::uint32_t>(alive.size());
        draw_batch(seed, keys, lanes, 0, Stream::scatter, draws_);
        cosine_hemisphere_batch(draws_, lanes, cosines_);
        slots_ = 0;
        if (candidates_ == 1) return;
        for (std::uint32_t lane = 0; lane < lanes; ++lane) {
            slot_[lane] = static_cast<std::uint8_t>(slots_);
            if (paths[alive[lane]].depth > candidate_depth_) continue;
            slot_keys_.pixel[slots_] = keys.pixel[lane];
            slot_keys_.sample[slots_] = keys.sample[lane];
            slot_keys_.vertex[slots_++] = keys.vertex[lane] * kMostCandidates;
        }
        seed_ = seed;
        if (several()) draw_batch(seed, slot_keys_, slots_, 0, Stream::candidate, picks_);
    }

    // Sampling's data is prefetched in steps, each addressed by the one before.
    void prefetch(std::uint32_t region, std::uint32_t lane) const { G::prefetch(guide_, region, draws_.word[1][lane]); }
    void prefetch_more(const Path& path) const {
        if (path.found) G::prefetch_more(guide_, path.guidance.region, draws_.word[1][path.lane]);
    }
    void prefetch_local(const Path& path) const { G::prefetch_local(guide_, path.guidance, draws_.word[1][path.lane]); }

    /// Start of a step, before any of its paths draws; `alive`: indices of the paths that will.
    void start(std::span<const Path> paths, std::span<const std::uint8_t> alive) {
        batch_.clear();
        if constexpr (kGuided && G::kLocal)
            for (const std::uint8_t index : alive)
                G::prefetch_local_more(guide_, paths[index].guidance, draws_.word[1][paths[index].lane]);
    }

    // Order: draw() for each path, then convert(), then choose(), then complete() for each.

    /// Draws a path's direction, or the first of its candidates; false if there is none.
    bool draw(Path& path) {
        if (chooses(path)) {
            offered_[slot(path)].candidates.clear();
            draw_offer(path, 0, batch_, draws_, cosines_, path.lane);
            return true;
        }
        return batch_.draw(*path.surface, guide_, path.guidance, to_unit(draws_.word[0][path.lane]), draws_[path.lane],
                           cosines_[path.lane], path.scatter);
    }
    void convert() { batch_.convert(guide_); }
    /// Draws the other candidates of paths that have several, and chooses one for each. The density is 0 if all failed.
    void choose(std::span<Path> paths, std::span<const std::uint8_t> alive) {
        if (!several()) return;
        std::array<std::uint8_t, kDrawBatch> choosers;
        std::uint32_t count = 0;
        for (const std::uint8_t index : alive)
            if (chooses(paths[index])) choosers[count++] = index;
        complete_offers(paths, {choosers.data(), count}, batch_);
        for (std::uint32_t candidate = 1; candidate < candidates_; ++candidate) {
            draw_batch(seed_, slot_keys_, slots_, candidate, Stream::candidate, more_draws_);
            cosine_hemisphere_batch(more_draws_, slots_, more_cosines_);
            more_.clear();
            for (std::uint32_t i = 0; i < count; ++i)
                draw_offer(paths[choosers[i]], candidate, more_, more_draws_, more_cosines_, slot(paths[choosers[i]]));
            more_.convert(guide_);
            complete_offers(paths, {choosers.data(), count}, more_);
        }
        for (std::uint32_t i = 0; i < count; ++i) {
            Path& path = paths[choosers[i]];
            const float pick = to_unit(picks_.word[0][slot(path)]);
            if (offered_[slot(path)].candidates.take(candidates_, pick, path.scatter)) continue;
            path.scatter.pdf = 0.0f;
            path.scatter.delta = false;
        }
    }
    void complete(Path& path) const {
        if (!chooses(path)) batch_.complete(*path.surface, guide_, path.guidance, path.scatter);
    }

  private:
    using Batch = typename G::template ScatterBatch<kGuided, kConverts>;

    /// Whether any path of this step may have several candidates.
    bool several() const { return slots_ != 0; }

    /// Candidates of a path.
    struct Offered {
        Candidates<typename G::Scatter> candidates;
        bool drawn;  ///< a direction is drawn and not completed
    };

    /// Whether a path chooses among candidates. False if there may be a delta lobe, which has no density to weight by.
    bool chooses(const Path& path) const {
        return kGuided && several() && path.depth <= candidate_depth_ && !path.surface->has_delta();
    }
    std::uint32_t slot(const Path& path) const { return slot_[path.lane]; }

    /// Draws a candidate with a technique from its own stratum: together the candidates sample the usual mixture.
    void draw_offer(const Path& path, std::uint32_t candidate, Batch& batch, const DrawBatch& draws,
                    const VectorBatch& cosines, std::uint32_t lane) {
        Offered& offered = offered_[slot(path)];
        const float technique =
            (static_cast<float>(candidate) + to_unit(draws.word[0][lane])) / static_cast<float>(candidates_);
        offered.drawn = batch.draw(*path.surface, guide_, path.guidance, technique, draws[lane], cosines[lane],
                                   offered.candidates.next());
    }

    void complete_offers(std::span<const Path> paths, std::span<const std::uint8_t> choosers, const Batch& batch) {
        for (const std::uint8_t index : choosers) {
            const Path& path = paths[index];
            Offered& offered = offered_[slot(path)];
            if (!offered.drawn) continue;
            batch.complete(*path.surface, guide_, path.guidance, offered.candidates.next());
            offered.candidates.offer();
        }
    }

    const Sampler& guide_;
    const std::uint32_t candidates_;
    const int candidate_depth_;
    DrawBatch draws_;
    VectorBatch cosines_;
    Batch batch_;

    // Slots of the paths that may have several candidates.
    std::uint32_t slots_ = 0;
    std::array<std::uint8_t, kDrawBatch> slot_;  ///< by lane
    std::uint64_t seed_ = 0;
    KeyBatch slot_keys_;
    DrawBatch picks_, more_draws_;
    VectorBatch more_cosines_;
    Batch more_;
    std::array<Offered, kGuided ? kDrawBatch : 0> offered_;
};

}  // namespace treefarm
