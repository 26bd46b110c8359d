#pragma once

#include "worker/integrator/path_settings.h"
#include "worker/lights/light_batch.h"

namespace treefarm {

/// The emitters that next event samples at the vertices of a step, by Path::lane. Where some are drawn together, each
/// path's is chosen before any vertex is visited: clear(), choose() for each, draw().
class EmitterChoice {
  public:
    EmitterChoice(const Emitters& emitters, const PathSettings& settings)
        : emitters_(emitters),
          needed_(settings.next_event || settings.delta_alone),
          delta_alone_(settings.delta_alone),
          together_(settings.next_event && emitters.draws_together()),
          from_map_(together_ && emitters.has_map()),
          special_(delta_alone_ || together_) {}

    /// The random numbers of a step.
    void draw_numbers(std::uint64_t seed, const KeyBatch& keys, std::uint32_t lanes, std::uint32_t vertex) {
        if (needed_) draw_batch(seed, keys, lanes, vertex, Stream::light, draws_);
    }

    /// Whether there is anything to sample in this pass.
    bool any() const { return needed_; }
    bool together() const { return together_; }
    void clear() { batch_.clear(); }
    void choose(std::uint32_t lane, const Vec3& p, const LightShare* share) {
        emitters_.choose(batch_, lane, p, draws_[lane], share);
    }
    void draw() { emitters_.draw(batch_); }

    /// As Emitters::sample_direct(), or sample_delta() where next event is for those alone.
    DirectSample sample(const Vec3& p, std::uint32_t lane, const LightShare* share, const Vec3* front) const {
        if (special_) [[unlikely]]
            return sample_specially(p, lane, share, front);
        return emitters_.sample_direct(p, draws_[lane], share, front);
    }
    /// What comes from infinity along a sample of it.
    [[gnu::noinline]] Rgb environment(std::uint32_t lane, const Vec3& direction) const {
        return together_ ? emitters_.environment(batch_, lane, direction) : emitters_.environment(direction);
    }
    /// Fetches what environment() reads, for the lanes lane_of(0) to lane_of(count - 1).
    template <class LaneOf>
    void prefetch(std::uint32_t count, LaneOf lane_of) const {
        if (from_map_) [[unlikely]]
            for (std::uint32_t i = 0; i < count; ++i)
                emitters_.prefetch_environment(batch_, lane_of(i));
    }

  private:
    /// Out of line: most scenes pay one test for it.
    [[gnu::noinline]] DirectSample sample_specially(const Vec3& p, std::uint32_t lane, const LightShare* share,
                                                    const Vec3* front) const {
        if (delta_alone_) return emitters_.sample_delta(p, draws_[lane]);
        return emitters_.sample_direct(p, batch_, lane, draws_[lane], share, front);
    }

    const Emitters& emitters_;
    const bool needed_, delta_alone_, together_, from_map_, special_;
    DrawBatch draws_;
    LightBatch batch_;
};

}  // namespace treefarm
