// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/base/random_batch.h"
#include "common/math/vector_batch.h"
#include "worker/lights/light_space.h"

namespace treefarm {

/// A chosen emitter; `entry` is its index in the table of all, kNone if none was chosen.
struct LightPick {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::uint32_t entry = kNone;
    float probability = 0;
    std::uint8_t cluster = 0;       ///< cluster of its learned probability
    float cluster_probability = 1;  ///< probability of the emitter within its cluster
};

/// Probability of the defensive choice, which uses no estimate: half of it by power, half evenly.
inline constexpr float kDefensive = 0.125f;

/// Batch of points at each of which one of few emitters is chosen: add() each, then FlatLights::pick().
struct FlatBatch {
    static constexpr std::size_t kMostLights = kLightClusters;
    template <class T>
    using Points = std::array<T, kDrawBatch>;

    void clear() { count = 0; }
    /// Adds a point for the caller's lane, with 32 random bits.
    void add(std::uint32_t lane, const LightReceiver& receiver, std::uint32_t random) {
        x[count] = receiver.p.x;
        y[count] = receiver.p.y;
        z[count] = receiver.p.z;
        nx[count] = receiver.front.x;
        ny[count] = receiver.front.y;
        nz[count] = receiver.front.z;
        one_sided[count] = receiver.one_sided;
        learned[count] = receiver.probabilities;
        bits[count] = random >> 1;
        of_lane[lane] = static_cast<std::uint8_t>(count);
        lane_of[count++] = static_cast<std::uint8_t>(lane);
    }
    /// Writes the probabilities of all emitters at a lane's point, in units of kLightUnit.
    void copy_widths(std::uint32_t lane, std::int32_t* to, std::size_t lights) const {
        for (std::size_t k = 0; k < lights; ++k)
            to[k] = widths[k][of_lane[lane]];
    }

    std::uint32_t count = 0;
    alignas(64) Points<float> x{}, y{}, z{}, nx{}, ny{}, nz{};
    Points<std::uint32_t> one_sided{}, bits{};
    Points<std::uint32_t> chosen{};       ///< index in FlatLights
    Points<std::int32_t> chosen_width{};  ///< its probability, in units of kLightUnit
    std::array<Points<std::int32_t>, kMostLights> widths{};
    Points<const LightProbabilities*> learned{};
    Points<std::uint8_t> of_lane{}, lane_of{};
};

/// Choice among few emitters by their estimated contribution to a point: all are evaluated, and each is its own
/// cluster.
class FlatLights {
  public:
    /// Largest number of emitters: the number of learned clusters.
    static constexpr std::size_t kMost = kLightClusters;

    /// `shares`: probabilities of the defensive choice, summing to 1; emitters with 0 are never chosen. At most kMost
    /// are above 0.
    FlatLights(std::span<const LightBounds> bounds, std::span<const double> shares);

    /// Chooses an emitter by 32 random bits.
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

    /// Chooses for all points of a batch; equal to pick() at each point, to the bit.
    void pick(FlatBatch& batch) const;
    /// Chosen emitter of a point of the batch.
    LightPick picked(const FlatBatch& batch, std::uint32_t point) const {
        const std::uint32_t lane = batch.chosen[point];
        if (lane >= count_) return {};
        const float probability = static_cast<float>(batch.chosen_width[point]) * kLightUnit;
        return {entry_[lane], probability, static_cast<std::uint8_t>(lane), probability};
    }

    /// Probability with which pick() chooses an entry.
    float probability(std::uint32_t entry, const LightReceiver& receiver) const {
        const std::size_t lane = lane_[entry];
        if (lane >= kLanes) return 0.0f;
        if (receiver.widths) return static_cast<float>(receiver.widths[lane]) * kLightUnit;
        return Widths(*this, receiver).probability(lane);
    }
    std::size_t count() const { return count_; }

  private:
    static constexpr std::size_t kLanes = 16;
    static constexpr float kOne = static_cast<float>(kLightWhole) * kLightMargin;
    static constexpr float kLearned = kOne * (1.0f - kDefensive) / static_cast<float>(kLightProbabilityOne);

    /// Probability of the choice by estimate, in units of kLightUnit.
    static float estimated_part(const LightProbabilities* learned) {
        return learned ? kLearned * static_cast<float>((*learned)[0]) : kOne * (1.0f - kDefensive);
    }

    /// Probabilities of all lanes, in units of kLightUnit.
    struct Widths {
        alignas(32) std::int32_t of[kLanes] = {};

        Widths(const FlatLights& lights, const LightReceiver& receiver) {
            alignas(32) LightLanes::Floats brings[2];
            const Vec3 p = lights.space_.normalised(receiver.p);
            lights.lanes_[0].estimate(p, receiver, brings[0]);
            float total = sum_of(brings[0]);
            if (lights.count_ > LightLanes::kCount) {
                lights.lanes_[1].estimate(p, receiver, brings[1]);
                total += sum_of(brings[1]);
            }
            const LightProbabilities* learned = receiver.probabilities;
            const float estimated = estimated_part(learned);
            const float scale = total > kLeastLight ? estimated / total : 0.0f;
            for (std::size_t block = 0; block * LightLanes::kCount < lights.count_; ++block)
                for (std::size_t k = 0; k < LightLanes::kCount; ++k)
                    of[block * LightLanes::kCount + k] = static_cast<std::int32_t>(
                        brings[block][k] * scale + lights.fixed_[block * LightLanes::kCount + k]);
            if (!learned) return;
            // Rounded to whole numbers each: the rounding remainder chooses no emitter.
            for (std::size_t k = 0; k < kLightClusters; ++k)
                of[k] += static_cast<std::int32_t>(kLearned * static_cast<float>((*learned)[k + 1]));
        }
        float probability(std::size_t lane) const { return static_cast<float>(of[lane]) * kLightUnit; }
    };

    LightSpace space_;
    std::array<LightLanes, 2> lanes_;
    /// probability of each lane in the defensive choice, in units of kLightUnit
    alignas(32) std::array<float, kLanes> fixed_{};
    std::array<std::uint32_t, kLanes> entry_{};  ///< table entry of a lane
    std::vector<std::uint8_t> lane_;             ///< lane of a table entry; kLanes: never chosen
    std::size_t count_ = 0;                      ///< lanes in use
};

}  // namespace treefarm
