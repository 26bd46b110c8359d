// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "worker/integrators/path/path_settings.h"
#include "worker/lights/light_batch.h"

namespace treefarm {

/// The emitters that next event samples at the vertices of a step, by Path::lane. Where some are drawn together, each
/// path's is chosen before any is sampled: clear(), choose() for each, draw().
class EmitterChoice {
  public:
    EmitterChoice(const Emitters& emitters, const PathSettings& settings)
        : emitters_(emitters),
          needed_(settings.next_event || settings.delta_alone),
          delta_alone_(settings.delta_alone),
          together_(settings.next_event && emitters.draws_together()),
          special_(delta_alone_ || together_) {}

    /// The random numbers of a step.
    void draw_numbers(std::uint64_t seed, const KeyBatch& keys, std::uint32_t lanes) {
        if (needed_) draw_batch(seed, keys, lanes, 0, Stream::light, draws_);
    }

    /// Whether there is anything to sample in this pass.
    bool any() const { return needed_; }
    bool together() const { return together_; }
    void clear() { batch_.clear(); }
    void choose(std::uint32_t lane, const LightReceiver& receiver) {
        emitters_.choose(batch_, lane, receiver, draws_[lane]);
    }
    void draw() { emitters_.draw(batch_); }

    /// A next-event sample as of Emitters::sample_direct(), or sample_delta() where next event is for those alone.
    DirectSample sample(const LightReceiver& receiver, std::uint32_t lane) const {
        if (special_) [[unlikely]]
            return sample_specially(receiver.p, lane);
        return emitters_.sample_direct(receiver, draws_[lane]);
    }
    /// Completes the samples from infinity among `lights`, of those numbers that are seen, by radiance and missing
    /// density; lane_of(light) has drawn one. All together: the others then have no test for it, nor a call to save
    /// registers for.
    template <class Lights, class LaneOf>
    void shine_from_infinity(Lights& lights, std::span<const std::uint8_t> seen, LaneOf lane_of) const {
        if (emitters_.shines_from_infinity()) [[unlikely]]
            add_infinity(lights, seen, lane_of);
    }

  private:
    /// Out of line: most scenes pay one test for it.
    [[gnu::noinline]] DirectSample sample_specially(const Vec3& p, std::uint32_t lane) const {
        if (delta_alone_) return emitters_.sample_delta(p, draws_[lane]);
        return emitters_.sample_direct(batch_, lane, draws_[lane]);
    }

    template <class Lights, class LaneOf>
    [[gnu::noinline]] void add_infinity(Lights& lights, std::span<const std::uint8_t> seen, LaneOf lane_of) const {
        if (together_ && emitters_.has_map())
            for (const std::uint8_t i : seen)
                emitters_.prefetch_environment(batch_, lane_of(lights[i]));
        for (const std::uint8_t i : seen) {
            auto& light = lights[i];
            if (!light.from_environment) continue;
            light.radiance =
                together_ ? emitters_.environment(batch_, lane_of(light), light.wi) : emitters_.environment(light.wi);
            if (together_) light.pdf = emitters_.environment_pdf(batch_, lane_of(light), light.pdf);
        }
    }

    const Emitters& emitters_;
    const bool needed_, delta_alone_, together_, special_;
    DrawBatch draws_;
    LightBatch batch_;
};

}  // namespace treefarm
