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
    explicit PathRecorder(GuidingTarget target = GuidingTarget::radiance) : target_(target) {}

    void begin_path() {
        vertices_.clear();
        light_samples_.clear();
        outside_ = 0;
    }

    /// A direction was sampled: region and code of the record, its density, f |cos| / density, and the bin of the
    /// mixture histogram.
    void add_vertex(std::uint32_t region, std::uint32_t code, float pdf, const Rgb& weight, std::uint8_t bin,
                    std::uint32_t vertex) {
        vertices_.push_back({weight, Rgb(0.0f), Rgb(0.0f), 1.0f, pdf, region, code, vertex, bin});
    }

    static constexpr std::uint32_t kNotRecorded = 0xffffffffu;

    /// The same of a delta lobe: its direction is no record, but what it carried belongs to the vertices before it, and
    /// to the mixture of the region where the BSDF has lobes besides; kNotRecorded where it has not.
    void add_delta_vertex(const Rgb& weight, std::uint32_t region, std::uint32_t vertex) {
        vertices_.push_back({weight, Rgb(0.0f), Rgb(0.0f), 1.0f, 0.0f, region, 0, vertex, kMixtureBins - 1});
    }

    /// Emission that the last sampled direction met, weighted against next event.
    void add_emission(const Rgb& radiance) {
        if (!vertices_.empty()) vertices_.back().emission += radiance;
    }

    std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(vertices_.size()); }

    /// What next event reflects where the path had so many vertices: at the end of the direction sampled at the last of
    /// them.
    void add_reflected(std::uint32_t vertex_count, const Rgb& radiance) {
        if (vertex_count != 0) vertices_[vertex_count - 1].reflected += radiance;
    }

    /// The path survived roulette after the last sampled direction met its surface.
    void survive(float probability) {
        if (!vertices_.empty()) vertices_.back().survival = probability;
    }

    /// A next-event sample that is a record itself (kick-start passes): weighted radiance and density.
    void add_light_sample(std::uint32_t region, std::uint32_t code, float radiance, float pdf, std::uint32_t vertex) {
        light_samples_.push_back({region, code, vertex, radiance, pdf});
    }

    void add_outside() { ++outside_; }

    /// Appends the path's records. Returns how many vertices and next-event samples were counted.
    std::uint64_t commit(const PathKey& path, RecordLog& log) {
        Rgb carried(0.0f);
        std::uint64_t recorded = light_samples_.size();
        for (std::size_t i = vertices_.size(); i-- > 0;) {
            const Vertex& v = vertices_[i];
            carried = v.emission + (v.reflected + carried) * (1.0f / v.survival);
            const Rgb arriving = carried;
            carried *= v.weight;
            if (v.region == kNotRecorded) continue;
            const float reflected = finite(average(carried));
            if (v.pdf > 0.0f) {
                ++recorded;
                ++log.counts[v.region];
                const float value = target_value(average(arriving), v.pdf);
                append(path, v.vertex, Stream::rounding, {v.region, v.code, 0, value, reflected, v.bin}, log);
            } else {  // a delta lobe of a BSDF that has others: it only teaches how often to sample the BSDF
                append(path, v.vertex, Stream::rounding, {v.region, 0, 0, 0.0f, reflected, v.bin}, log);
            }
        }
        for (const LightSample& s : light_samples_) {
            ++log.counts[s.region];
            append(path, s.vertex, Stream::light_rounding,
                   {s.region, s.code, 0, target_value(s.radiance, s.pdf), 0.0f, 0}, log);
        }
        log.caps.outside_positions += outside_;
        return recorded;
    }

  private:
    struct Vertex {
        Rgb weight, emission, reflected;
        float survival, pdf;
        std::uint32_t region, code, vertex;
        std::uint8_t bin;
    };
    struct LightSample {
        std::uint32_t region, code, vertex;
        float radiance, pdf;
    };

    /// A value beyond float becomes the largest one: the sums cap it, and count that.
    static float finite(float value) { return std::min(value, std::numeric_limits<float>::max()); }

    /// L / p, or L^2 / p for the second moment.
    float target_value(float radiance, float pdf) const {
        return finite(target_ == GuidingTarget::variance ? radiance * (radiance / pdf) : radiance / pdf);
    }

    static void append(const PathKey& path, std::uint32_t vertex, Stream rounding, Record record, RecordLog& log) {
        if (!(record.value > 0.0f)) record.value = 0.0f;  // also NaN
        if (!(record.reflected > 0.0f)) record.reflected = 0.0f;
        if (record.value == 0.0f && record.reflected == 0.0f) return;
        record.rounding = draw(path, vertex, rounding)[0];
        log.records.push_back(record);
    }

    GuidingTarget target_;
    std::vector<Vertex> vertices_;
    std::vector<LightSample> light_samples_;
    std::uint64_t outside_ = 0;
};

}  // namespace treefarm
