#pragma once

#include <span>

#include "worker/integrator/candidates.h"
#include "worker/integrator/path_settings.h"
#include "worker/integrator/path_state.h"

namespace treefarm {

/// The directions that a batch of paths takes in a step. Each draws one, or several, of which it takes one.
template <class Surface, bool kGuided, bool kCoded, bool kViews>
class DirectionChoice {
  public:
    using Path = PathState<Surface>;

    DirectionChoice(const Guide& guide, const PathSettings& settings)
        : guide_(guide), candidates_(kGuided ? settings.candidates : 1), candidate_depth_(settings.candidate_depth) {}

    /// The random numbers of a step; Path::lane says which are a path's.
    /// `least_depth`: of their vertices.
    void draw_numbers(std::uint64_t seed, const KeyBatch& keys, std::uint32_t lanes, int least_depth) {
        draw_batch(seed, keys, lanes, 0, Stream::scatter, draws_);
        cosine_hemisphere_batch(draws_, lanes, cosines_);
        several_ = candidates_ > 1 && least_depth <= candidate_depth_;
        if (!several_) return;
        seed_ = seed;
        keys_ = keys;
        lanes_ = lanes;
        for (std::uint32_t& vertex : keys_.vertex)
            vertex *= Candidates::kMost;
        draw_batch(seed, keys_, lanes, 0, Stream::candidate, picks_);
    }

    /// Whether the paths of this step choose among several.
    bool several() const { return several_; }

    // What sampling will read is fetched ahead, each time by what the last has brought.
    void prefetch(std::uint32_t region, std::uint32_t lane) const {
        guide_.prefetch(region, draws_.word[1][lane]);
        if constexpr (kViews) guide_.prefetch_views(region);
    }
    void prefetch_cell(const Path& path) const {
        if (path.found) guide_.prefetch_cell(path.guidance.region, draws_.word[1][path.lane]);
    }
    void prefetch_view(const Path& path) const {
        if (path.guidance.has_view()) guide_.prefetch(path.guidance.view, draws_.word[1][path.lane]);
    }

    /// Before any path of a step draws; `alive` are the numbers of those that will.
    void start(std::span<const Path> paths, std::span<const std::uint8_t> alive) {
        batch_.clear();
        if constexpr (kGuided && kViews)
            for (const std::uint8_t index : alive)
                if (const Path& path = paths[index]; path.guidance.has_view())
                    guide_.prefetch_cell(path.guidance.view, draws_.word[1][path.lane]);
    }

    // One: draw(), then convert(), then complete().
    bool draw(Path& path) { return draw(path, technique(path)); }
    void convert() { batch_.convert(guide_); }
    void complete(Path& path) const { batch_.complete(*path.surface, guide_, path.guidance, path.scatter); }

    /// Several, for the paths whose numbers are in `alive`. The density is 0 where none was found.
    void draw_several(std::span<Path> paths, std::span<const std::uint8_t> alive) {
        for (const std::uint8_t index : alive)
            offered_[index].clear();
        for (std::uint32_t candidate = 0; candidate < candidates_; ++candidate) {
            if (candidate != 0) {
                draw_batch(seed_, keys_, lanes_, candidate, Stream::candidate, draws_);
                cosine_hemisphere_batch(draws_, lanes_, cosines_);
                batch_.clear();
            }
            std::array<std::uint8_t, kDrawBatch> drawn;
            std::uint32_t count = 0;
            for (const std::uint8_t index : alive) {
                Path& path = paths[index];
                const std::uint32_t of = candidates_of(path);
                if (candidate >= of) continue;
                // Each from its own part of the techniques' probabilities: a mixture over the candidates like any.
                const float stratum = (static_cast<float>(candidate) + technique(path)) / static_cast<float>(of);
                if (draw(path, stratum)) drawn[count++] = index;
            }
            convert();
            for (std::uint32_t i = 0; i < count; ++i) {
                Path& path = paths[drawn[i]];
                complete(path);
                offered_[drawn[i]].offer(path.scatter);
            }
        }
        for (const std::uint8_t index : alive) {
            Path& path = paths[index];
            const float pick = to_unit(picks_.word[0][path.lane]);
            if (!offered_[index].take(candidates_of(path), pick, path.scatter)) path.scatter.pdf = 0.0f;
        }
    }

  private:
    /// A delta lobe has no density to weigh by.
    std::uint32_t candidates_of(const Path& path) const {
        return path.probe || path.depth > candidate_depth_ || path.surface->has_delta() ? 1 : candidates_;
    }

    float technique(const Path& path) const { return to_unit(draws_.word[0][path.lane]); }

    bool draw(Path& path, float technique) {
        return batch_.draw(*path.surface, guide_, path.guidance, technique, draws_[path.lane], cosines_[path.lane],
                           path.scatter);
    }

    const Guide& guide_;
    const std::uint32_t candidates_;
    const int candidate_depth_;
    bool several_ = false;
    std::uint64_t seed_ = 0;
    std::uint32_t lanes_ = 0;
    KeyBatch keys_;
    DrawBatch draws_, picks_;
    VectorBatch cosines_;
    ScatterBatch<kGuided, kCoded, kViews> batch_;
    std::array<Candidates, kGuided ? kDrawBatch : 0> offered_;
};

}  // namespace treefarm
