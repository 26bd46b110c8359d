// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "worker/integrators/path/path_settings.h"
#include "worker/lights/light_batch.h"

namespace treefarm {

/// Choice of the emitters that next event samples at the vertices of a step, indexed by Path::lane. If some are drawn
/// together, each path's emitter is chosen before any is sampled: clear(), choose() for each, draw().
class EmitterChoice {
  public:
    EmitterChoice(const Emitters& emitters, const PathSettings& settings)
        : emitters_(emitters),
          needed_(settings.next_event || settings.delta_alone),
          delta_alone_(settings.delta_alone),
          together_(settings.next_event && emitters.draws_together()),
          special_(delta_alone_ || together_),
          few_(settings.few_light_samples) {}

    /// Draws the random numbers of a step, unless only few of its vertices need them.
    void draw_numbers(std::uint64_t seed, const KeyBatch& keys, std::uint32_t lanes) {
        if (needed_ && !few_) draw_batch(seed, keys, lanes, 0, Stream::light, draws_);
    }

    /// Whether this pass samples emitters at all.
    bool any() const { return needed_; }
    bool together() const { return together_; }
    void clear() { batch_.clear(); }
    template <class Path>
    void choose(const Path& path, const LightReceiver& receiver) {
        if (few_) draw_alone(path);
        emitters_.choose(batch_, path.lane, receiver, draws_[path.lane]);
    }
    void draw() { emitters_.draw(batch_); }
    /// Keeps intermediate results of a choice, for a density that may be needed at that vertex (Emitters::keep()).
    void keep(std::uint32_t lane, LightReceiver& receiver, LightWidthStore& storage) const {
        if (together_) [[unlikely]]
            emitters_.keep(batch_, lane, receiver, storage);
    }

    /// Next-event sample by Emitters::sample_direct(), or by sample_delta() if only lights without extent are sampled.
    template <class Path>
    DirectSample sample(const LightReceiver& receiver, const Path& path) {
        if (few_ && !together_) [[unlikely]]
            draw_alone(path);
        if (special_) [[unlikely]]
            return sample_specially(receiver.p, path.lane);
        return emitters_.sample_direct(receiver, draws_[path.lane]);
    }
    /// Completes the visible samples of light from infinity by radiance and missing density; `seen`: their indices in
    /// `lights`, lane_of(light): the lane that drew one. In one loop, so that other samples need no test and no call.
    template <class Lights, class LaneOf>
    void shine_from_infinity(Lights& lights, std::span<const std::uint8_t> seen, LaneOf lane_of) const {
        if (emitters_.shines_from_infinity()) [[unlikely]]
            add_infinity(lights, seen, lane_of);
    }

  private:
    /// Draws the random numbers of one vertex, equal to those that draw_numbers() would give it.
    template <class Path>
    void draw_alone(const Path& path) {
        const Draw draw = treefarm::draw(path.key, path.vertex, Stream::light);
        for (std::size_t i = 0; i < draw.size(); ++i)
            draws_.word[i][path.lane] = draw[i];
    }

    /// Sample from a batch, or of a light without extent; out of line, since most scenes only pay one test for it.
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
    const bool needed_, delta_alone_, together_, special_, few_;
    DrawBatch draws_;
    LightBatch batch_;
};

}  // namespace treefarm
