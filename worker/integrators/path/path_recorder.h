// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "common/base/random.h"
#include "worker/integrators/record_log.h"

namespace treefarm {

/// Bins of a direction in the histograms that learn mixtures (mixture.h, view_mixture.h).
struct MixtureBins {
    std::uint8_t region = 0, view = 0;
};

/// Remembers the vertices of one path and, at its end, what radiance each sampled direction carried:
///   L_i = emission_i + (reflected_i + weight_(i+1) L_(i+1)) / survival_i,
/// where emission_i was met by the direction sampled at vertex i, and reflected_i is what next event found at its end.
/// Its memory grows to the longest path and stays.
class PathRecorder {
  public:
    explicit PathRecorder(GuidingTarget target = GuidingTarget::radiance,
                          ViewRecords view_records = ViewRecords::product)
        : target_(target), view_records_(view_records) {}

    void begin_path() {
        vertices_.clear();
        light_samples_.clear();
        choices_.clear();
        outside_ = 0;
    }

    /// Begins the other way out of a path's first surface, by a delta lobe of this weight.
    void begin_other_way(const Rgb& weight) {
        begin_path();
        add_delta_vertex(weight, {}, 0);
    }

    /// A direction was sampled: its code and density, f |cos| / density, its bins of the mixture histograms, and the
    /// random bits by which its records are rounded.
    void add_vertex(const RecordTarget& target, std::uint32_t code, float pdf, const Rgb& weight,
                    const MixtureBins& bins, std::uint32_t rounding) {
        vertices_.push_back({weight, Rgb(0.0f), Rgb(0.0f), 1.0f, pdf, target, code, rounding, bins});
    }

    /// A direction of a delta lobe was sampled: it is no record, but what it carried belongs to the vertices before it,
    /// and to the mixture where the BSDF has lobes besides; the target is empty where it has not.
    void add_delta_vertex(const Rgb& weight, const RecordTarget& target, std::uint32_t rounding) {
        vertices_.push_back(
            {weight, Rgb(0.0f), Rgb(0.0f), 1.0f, 0.0f, target, 0, rounding, {kMixtureBins - 1, kMixtureBins - 1}});
    }

    /// Emission that the last sampled direction met, weighted against next event.
    void add_emission(const Rgb& radiance) {
        if (!vertices_.empty()) vertices_.back().emission += radiance;
    }

    std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(vertices_.size()); }

    /// Light that next event reflects where the path had so many vertices: at the end of the direction sampled at the
    /// last of them.
    void add_reflected(std::uint32_t vertex_count, const Rgb& radiance) {
        if (vertex_count != 0) vertices_[vertex_count - 1].reflected += radiance;
    }

    /// The path survived roulette after the last sampled direction met its surface.
    void survive(float probability) {
        if (!vertices_.empty()) vertices_.back().survival = probability;
    }

    /// A next-event sample that is a record itself (kick-start passes): weighted radiance, what of it is reflected over
    /// the density, and the density.
    void add_light_sample(const RecordTarget& target, std::uint32_t code, const Rgb& radiance, float reflected,
                          float pdf, std::uint32_t rounding) {
        light_samples_.push_back({target, rounding, {code, pdf, average(radiance), finite(reflected), {}, false}});
    }

    /// A record of what next event found, from which the choice of emitters learns.
    void add_choice(const Record& record) { choices_.push_back(record); }

    void add_outside() { ++outside_; }

    /// Appends the path's records. Returns how many vertices and next-event samples were counted.
    std::uint64_t commit(RecordLog& log) {
        Rgb carried(0.0f);
        std::uint64_t recorded = light_samples_.size();
        log.drafts.resize(std::max(log.drafts.size(), 2 * (vertices_.size() + light_samples_.size())));
        Record* end = log.drafts.data();
        for (std::size_t i = vertices_.size(); i-- > 0;) {
            const Vertex& v = vertices_[i];
            carried = v.emission + (v.reflected + carried) * (1.0f / v.survival);
            const Rgb arriving = carried;
            carried *= v.weight;
            const DirectionSample direction{v.code, v.pdf, average(arriving), finite(average(carried)), v.bins};
            if (v.target.empty()) continue;
            recorded += v.pdf > 0.0f;
            end = teach(v.rounding, v.target, direction, log, end);
        }
        for (const LightSample& s : light_samples_)
            end = teach(s.rounding, s.target, s.direction, log, end);
        log.records.insert(log.records.end(), log.drafts.data(), end);
        log.records.insert(log.records.end(), choices_.begin(), choices_.end());
        log.caps.outside_positions += outside_;
        return recorded;
    }

  private:
    struct Vertex {
        Rgb weight, emission, reflected;
        float survival, pdf;
        RecordTarget target;
        std::uint32_t code, rounding;
        MixtureBins bins;
    };
    /// Radiance that a direction carried.
    struct DirectionSample {
        std::uint32_t code;
        float pdf;        ///< 0: of a delta lobe beside others, which teaches how often to sample the BSDF
        float radiance;   ///< that arrived
        float reflected;  ///< of that, over the density
        MixtureBins bins;
        bool of_mixture = true;  ///< whether it was drawn from what the mixture mixes
    };
    struct LightSample {
        RecordTarget target;
        std::uint32_t rounding;
        DirectionSample direction;
    };

    /// Writes the records of a sampled direction. As published a view alone learns, and the radiance; otherwise the
    /// region learns that as it would without, and the view what is reflected. Records are written at `end`; returns
    /// the new one.
    Record* teach(std::uint32_t rounding, const RecordTarget& target, const DirectionSample& l, RecordLog& log,
                  Record* end) const {
        const bool smooth = l.pdf > 0.0f;
        const float value = smooth ? target_value(l.radiance, l.pdf) : 0.0f;
        const float mixture = l.of_mixture ? l.reflected : 0.0f;
        if (!target.has_view()) {
            log.counts[target.region] += smooth;
            return append({target.region, l.code, rounding, value, mixture, l.bins.region}, end);
        }
        const bool product = view_records_ == ViewRecords::product;
        if (product) {
            log.counts[target.region] += smooth;
            end = append({target.region, l.code, rounding, value, mixture, l.bins.region}, end);
        }
        log.counts[target.view] += smooth;
        const float of_view = product && smooth ? target_value(l.reflected * l.pdf, l.pdf) : value;
        return append({target.view, l.code, scrambled(rounding, kOfView), of_view, mixture, l.bins.view}, end);
    }

    /// A value beyond float becomes the largest one: the sums cap it, and count that.
    static float finite(float value) { return std::min(value, std::numeric_limits<float>::max()); }

    /// L / p, or L^2 / p for the second moment.
    float target_value(float radiance, float pdf) const {
        return finite(target_ == GuidingTarget::variance ? radiance * (radiance / pdf) : radiance / pdf);
    }

    /// Keeps a record, unless it has nothing to tell, which nothing would predict: no branch asks.
    static Record* append(Record record, Record* end) {
        record.value = record.value > 0.0f ? record.value : 0.0f;  // also NaN
        record.reflected = record.reflected > 0.0f ? record.reflected : 0.0f;
        *end = record;
        return end + (std::max(record.value, record.reflected) > 0.0f);
    }

    static constexpr std::uint32_t kOfView = 9;  ///< salt: a view's record is rounded apart from its region's

    GuidingTarget target_;
    ViewRecords view_records_;
    std::vector<Vertex> vertices_;
    std::vector<LightSample> light_samples_;
    std::vector<Record> choices_;
    std::uint64_t outside_ = 0;
};

}  // namespace treefarm
