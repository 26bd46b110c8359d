// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "worker/lights/light_space.h"

namespace treefarm {

/// An emitter that was chosen, of the table of all; `entry` is kNone where nothing was.
struct LightPick {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::uint32_t entry = kNone;
    float probability = 0;
    std::uint8_t cluster = 0;       ///< that it is learned by
    float cluster_probability = 1;  ///< with which one of the cluster was chosen
};

/// How many draw from what is not estimated, and may be wrong in no way: half by power, half evenly.
inline constexpr float kDefensive = 0.125f;

/// A choice among few emitters by what each brings to a point: all are looked at, and each is a cluster of its own.
class FlatLights {
  public:
    /// As many as there are clusters to learn by.
    static constexpr std::size_t kMost = kLightClusters;

    /// `shares`: how often each is chosen where nothing is estimated; they sum to 1, and those without are never
    /// chosen. At most kMost others.
    FlatLights(std::span<const LightBounds> bounds, std::span<const double> shares);

    /// Chooses by 32 random bits.
    LightPick pick(std::uint32_t bits, const LightReceiver& receiver) const {
        const Widths widths(*this, receiver);
        std::uint32_t end = 0;
        std::size_t lane = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            end += static_cast<std::uint32_t>(widths.of[k]);
            lane += end <= bits >> 1;
        }
        if (lane == count_) return {};
        const float probability = widths.probability(lane);
        return {entry_[lane], probability, static_cast<std::uint8_t>(lane), probability};
    }

    /// Probability with which pick() chooses an entry.
    float probability(std::uint32_t entry, const LightReceiver& receiver) const {
        const std::size_t lane = lane_[entry];
        return lane < kLanes ? Widths(*this, receiver).probability(lane) : 0.0f;
    }

  private:
    static constexpr std::size_t kLanes = 16;

    /// Probabilities of all lanes, in units of kLightUnit.
    struct Widths {
        alignas(32) std::int32_t of[kLanes] = {};

        Widths(const FlatLights& lights, const LightReceiver& receiver) {
            alignas(32) LightLanes::Floats brings[2];
            const Vec3 p = lights.space_.place(receiver.p);
            lights.lanes_[0].estimate(p, receiver, brings[0]);
            float total = sum_of(brings[0]);
            if (lights.count_ > LightLanes::kCount) {
                lights.lanes_[1].estimate(p, receiver, brings[1]);
                total += sum_of(brings[1]);
            }
            constexpr float kOne = static_cast<float>(kLightWhole) * kLightMargin;
            constexpr float kLearned = kOne * (1.0f - kDefensive) / static_cast<float>(kLightProbabilityOne);
            const LightProbabilities* learned = receiver.probabilities;
            const float estimated = learned ? kLearned * static_cast<float>((*learned)[0]) : kOne * (1.0f - kDefensive);
            const float scale = total > kLeastLight ? estimated / total : 0.0f;
            for (std::size_t block = 0; block * LightLanes::kCount < lights.count_; ++block)
                for (std::size_t k = 0; k < LightLanes::kCount; ++k)
                    of[block * LightLanes::kCount + k] = static_cast<std::int32_t>(
                        brings[block][k] * scale + lights.fixed_[block * LightLanes::kCount + k]);
            if (!learned) return;
            // Whole numbers each: what both parts leave to rounding draws nothing.
            for (std::size_t k = 0; k < kLightClusters; ++k)
                of[k] += static_cast<std::int32_t>(kLearned * static_cast<float>((*learned)[k + 1]));
        }
        float probability(std::size_t lane) const { return static_cast<float>(of[lane]) * kLightUnit; }
    };

    LightSpace space_;
    std::array<LightLanes, 2> lanes_;
    alignas(32) std::array<float, kLanes> fixed_{};  ///< what is chosen without an estimate, in units of kLightUnit
    std::array<std::uint32_t, kLanes> entry_{};      ///< of a lane
    std::vector<std::uint8_t> lane_;                 ///< of an entry; kLanes: never chosen
    std::size_t count_ = 0;                          ///< lanes in use
};

}  // namespace treefarm
