// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/base/random.h"
#include "worker/integrators/record_log.h"

namespace treefarm {

/// Record contents of one direction, for a guide `G` to learn from.
template <class G>
struct TaughtDirection {
    typename G::Direction direction;
    float pdf;        ///< 0: of a delta lobe beside others, which teaches only the probability of sampling the BSDF
    float radiance;   ///< incident radiance
    float reflected;  ///< reflected part of it, over the density
    typename G::Bins bins;
    bool of_mixture = true;  ///< whether the direction was drawn from the learned mixture
};

/// Recorder of one path: stores its vertices and, at its end, computes the radiance that each sampled direction
/// carried:
///   L_i = emission_i + (reflected_i + weight_(i+1) L_(i+1)) / survival_i,
/// where the direction sampled at vertex i has hit emission_i, and reflected_i is next event's result at its end. With
/// bootstrapping, L~_(i+1), the radiance that the region of vertex i + 1 has learned for the direction sampled there,
/// replaces the part beta of L_(i+1) (Q-learning: Dahm and Keller 2017, "Learning light transport the reinforced way";
/// beta < 1 keeps a part of the path's own result). This changes only records, which guide directions, and never the
/// image. The guide `G` defines the records of a vertex. Memory grows to the longest path and is kept.
template <class G>
class PathRecorder {
  public:
    using Target = typename G::Target;
    using Direction = typename G::Direction;
    using Bins = typename G::Bins;

    explicit PathRecorder(const RecordRules& rules = {}) : rules_(rules) {}

    void begin_path() {
        vertices_.clear();
        light_samples_.clear();
        choices_.clear();
        outside_ = 0;
    }

    /// Starts a record of the other branch at a path's first surface, by a delta lobe of this weight.
    void begin_other_branch(const Rgb& weight) {
        begin_path();
        add_delta_vertex(weight, {}, 0);
    }

    static constexpr float kUnknown = -1.0f;

    /// Adds a vertex with its sampled direction: the density, f |cos| / density, the bins in the mixture's histograms,
    /// the random bits that round its records, and the guide's estimate of the incident radiance, or kUnknown.
    void add_vertex(const Target& target, const Direction& direction, float pdf, const Rgb& weight, const Bins& bins,
                    std::uint32_t rounding, float known = kUnknown) {
        vertices_.push_back({weight, Rgb(0.0f), Rgb(0.0f), 1.0f, pdf, known, target, direction, rounding, bins});
    }

    /// Adds a vertex with a direction of a delta lobe. It yields no radiance record; its light counts for the vertices
    /// before it and, if the BSDF has other lobes, for the mixture. `target` is empty if it has none.
    void add_delta_vertex(const Rgb& weight, const Target& target, std::uint32_t rounding) {
        vertices_.push_back({weight, Rgb(0.0f), Rgb(0.0f), 1.0f, 0.0f, kUnknown, target, {}, rounding, G::kDeltaBins});
    }

    /// Adds emission that the last sampled direction hit, weighted against next event.
    void add_emission(const Rgb& radiance) {
        if (!vertices_.empty()) vertices_.back().emission += radiance;
    }

    std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(vertices_.size()); }

    /// Adds light that next event reflects at the end of direction number `vertex_count`: `vertex_count` is the number
    /// of vertices when it was sampled.
    void add_reflected(std::uint32_t vertex_count, const Rgb& radiance) {
        if (vertex_count != 0) vertices_[vertex_count - 1].reflected += radiance;
    }

    /// Records the survival of roulette after the last sampled direction.
    void survive(float probability) {
        if (!vertices_.empty()) vertices_.back().survival = probability;
    }

    /// Adds a next-event sample that is a record itself (kick-start passes): weighted radiance, its reflected part over
    /// the density, and the density.
    void add_light_sample(const Target& target, const Direction& direction, const Rgb& radiance, float reflected,
                          float pdf, std::uint32_t rounding) {
        light_samples_.push_back(
            {target, rounding, {direction, pdf, average(radiance), RecordRules::finite(reflected), {}, false}});
    }

    /// Adds a record of next event's result, from which the choice of emitters learns.
    void add_choice(const Record& record) { choices_.push_back(record); }

    void add_outside() { ++outside_; }

    /// Appends the path's records to `log`; those of the choice of emitters only if it holds such records. Returns the
    /// number of counted vertices and next-event samples.
    template <class Log>
    std::uint64_t commit(Log& log) {
        using LogRecord = typename Log::Record;
        Rgb carried(0.0f);
        float replaced = 0.0f;  // bootstrapping's addition to the mean of `carried`
        std::uint64_t recorded = light_samples_.size();
        log.drafts.resize(
            std::max(log.drafts.size(), G::kRecordsPerVertex * (vertices_.size() + light_samples_.size())));
        LogRecord* end = log.drafts.data();
        for (std::size_t i = vertices_.size(); i-- > 0;) {
            const Vertex& v = vertices_[i];
            carried = v.emission + (v.reflected + carried) * (1.0f / v.survival);
            float radiance = average(carried);
            carried *= v.weight;
            if (rules_.bootstrap > 0.0f) radiance += std::exchange(replaced, bootstrapped(v, carried)) / v.survival;
            const TaughtDirection<G> taught{v.direction, v.pdf, radiance, RecordRules::finite(average(carried)),
                                            v.bins};
            if (v.target.empty()) continue;
            recorded += v.pdf > 0.0f;
            end = G::teach(rules_, v.rounding, v.target, taught, log, end);
        }
        for (const LightSample& s : light_samples_)
            end = G::teach(rules_, s.rounding, s.target, s.taught, log, end);
        log.records.insert(log.records.end(), log.drafts.data(), end);
        if constexpr (std::is_same_v<LogRecord, Record>)
            log.records.insert(log.records.end(), choices_.begin(), choices_.end());
        log.caps.outside_positions += outside_;
        return recorded;
    }

  private:
    struct Vertex {
        Rgb weight, emission, reflected;
        float survival, pdf, known;
        Target target;
        Direction direction;
        std::uint32_t rounding;
        Bins bins;
    };
    /// Bootstrapping term beta (weight L~ - weight L) of a vertex.
    float bootstrapped(const Vertex& v, const Rgb& carried) const {
        if (v.known < 0.0f) return 0.0f;
        return rules_.bootstrap * (average(v.weight) * v.known - average(carried));
    }

    struct LightSample {
        Target target;
        std::uint32_t rounding;
        TaughtDirection<G> taught;
    };

    RecordRules rules_;
    std::vector<Vertex> vertices_;
    std::vector<LightSample> light_samples_;
    std::vector<Record> choices_;
    std::uint64_t outside_ = 0;
};

}  // namespace treefarm
