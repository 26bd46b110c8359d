#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "common/base/random.h"
#include "worker/integrator/record_log.h"

namespace treefarm {

/// Remembers the vertices of one path and, at its end, what radiance each sampled direction carried:
///   L_i = emission_i + (reflected_i + weight_(i+1) L_(i+1)) / survival_i,
/// where emission_i was met by the direction sampled at vertex i, and reflected_i is what next event found at its end.
/// Its memory grows to the longest path and stays.
class PathRecorder {
  public:
    void begin_path() {
        vertices_.clear();
        light_samples_.clear();
        outside_ = 0;
    }

    /// A direction was sampled: region and code of the record, its density, and f |cos| / density.
    void add_vertex(std::uint32_t region, std::uint32_t code, float pdf, const Rgb& weight, std::uint32_t vertex) {
        vertices_.push_back({weight, Rgb(0.0f), Rgb(0.0f), 1.0f, pdf, region, code, vertex});
    }

    /// The same of a delta lobe: its direction is no record, but what it carried belongs to the vertices before it.
    void add_delta_vertex(const Rgb& weight) {
        vertices_.push_back({weight, Rgb(0.0f), Rgb(0.0f), 1.0f, 0.0f, kNotRecorded, 0, 0});
    }

    /// Emission that the last sampled direction met, weighted against next event.
    void add_emission(const Rgb& radiance) {
        if (!vertices_.empty()) vertices_.back().emission += radiance;
    }

    /// What next event reflects at the end of the last sampled direction.
    void add_reflected(const Rgb& radiance) {
        if (!vertices_.empty()) vertices_.back().reflected += radiance;
    }

    /// The path survived roulette after the last sampled direction met its surface.
    void survive(float probability) {
        if (!vertices_.empty()) vertices_.back().survival = probability;
    }

    /// A next-event sample that is a record itself (kick-start passes).
    void add_light_sample(std::uint32_t region, std::uint32_t code, float value, std::uint32_t vertex) {
        light_samples_.push_back({region, code, vertex, value});
    }

    void add_outside() { ++outside_; }

    /// Appends the path's records. Returns how many vertices and next-event samples were counted.
    std::uint64_t commit(const PathKey& path, RecordLog& log) {
        Rgb carried(0.0f);
        std::uint64_t recorded = light_samples_.size();
        for (std::size_t i = vertices_.size(); i-- > 0;) {
            const Vertex& v = vertices_[i];
            carried = v.emission + (v.reflected + carried) * (1.0f / v.survival);
            if (v.region != kNotRecorded) {
                ++recorded;
                ++log.counts[v.region];
                append(path, {v.region, v.code, v.vertex, average(carried) / v.pdf}, Stream::rounding, log);
            }
            carried *= v.weight;
        }
        for (const LightSample& s : light_samples_) {
            ++log.counts[s.region];
            append(path, s, Stream::light_rounding, log);
        }
        log.caps.outside_positions += outside_;
        return recorded;
    }

  private:
    static constexpr std::uint32_t kNotRecorded = 0xffffffffu;

    struct Vertex {
        Rgb weight, emission, reflected;
        float survival, pdf;
        std::uint32_t region, code, vertex;
    };
    struct LightSample {
        std::uint32_t region, code, vertex;
        float value;
    };

    static void append(const PathKey& path, const LightSample& s, Stream rounding, RecordLog& log) {
        if (!(s.value > 0.0f)) return;
        // A value beyond float becomes the largest one: the sums cap it, and count that.
        const float value = std::min(s.value, std::numeric_limits<float>::max());
        log.records.push_back({s.region, s.code, draw(path, s.vertex, rounding)[0], value});
    }

    std::vector<Vertex> vertices_;
    std::vector<LightSample> light_samples_;
    std::uint64_t outside_ = 0;
};

}  // namespace treefarm
