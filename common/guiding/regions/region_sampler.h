// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/base/random.h"
#include "common/decide/next_event/next_event_sums.h"
#include "common/guiding/regions/region_model.h"
#include "common/math/level_block.h"
#include "common/math/vector_batch.h"

namespace treefarm {

/// The regions in the form that workers look them up in: a table above 8-way spatial treelets (bench/guide_bench.cpp
/// shows why), with the data per region. Base of every guide's sampler. Immutable; one per process, shared by its
/// threads.
class RegionSampler {
  public:
    explicit RegionSampler(const RegionModel& model);

    /// Whether anything was learned; false in the first pass, which samples the BSDF alone.
    bool trained() const { return trained_; }
    /// Number of distributions that count records: regions, and a guide's own besides.
    std::uint32_t distribution_count() const { return static_cast<std::uint32_t>(quantum_exponent_.size()); }
    std::uint32_t region_count() const { return static_cast<std::uint32_t>(region_depth_.size()); }
    std::int16_t quantum_exponent(std::uint32_t distribution) const { return quantum_exponent_[distribution]; }
    /// Probability of sampling the BSDF instead of the guide; `distribution`: the finest at the vertex.
    float bsdf_fraction(std::uint32_t distribution) const { return bsdf_fraction_[distribution]; }

    /// Whether next event learns to choose emitters.
    bool learns_lights() const { return !light_probabilities_.empty(); }
    /// Learned emitter choice of a region; nullptr: none.
    const LightProbabilities* light_probabilities(std::uint32_t region) const {
        return light_probabilities_.empty() ? nullptr : &light_probabilities_[region];
    }

    /// Light samples per vertex in a region, or in an image without guiding.
    float next_event(std::uint32_t region) const {
        return next_event_.empty() ? 1.0f : kNextEventSamples[next_event_[region]];
    }
    float image_next_event() const { return kNextEventSamples[image_.next_event]; }
    bool decides_next_event() const { return !next_event_.empty(); }
    /// Whether any vertex may have less than one light sample.
    bool thins_next_event(bool by_region) const { return by_region ? thins_next_event_ : image_.next_event != 0; }
    /// Whether light levels of the image are known; and the reciprocal level at a pixel.
    bool knows_image() const { return !image_.inverse_levels.empty(); }
    float inverse_level(std::uint32_t x, std::uint32_t y) const {
        const std::size_t block = level_block(x, y, image_.columns);
        return block < image_.inverse_levels.size() ? image_.inverse_levels[block] : 0.0f;
    }

    /// Learned integral of radiance over directions in a region; 0: unknown.
    float flux(std::uint32_t region) const { return flux_.empty() ? 0.0f : flux_[region]; }

    /// Region of a point. Points outside the cube belong to the nearest region (the caller may count them, by
    /// contains()).
    std::uint32_t region(const Vec3& position) const;
    /// Regions of the first `count` points, computed in step, so that memory latency and differences in depth overlap.
    void regions(const VectorBatch& positions, std::uint32_t count, std::array<std::uint32_t, kDrawBatch>& found) const;
    bool contains(const Vec3& position) const {
        // Points of the outermost surfaces may be outside by a rounding error.
        const float low = -1e-4f * extent_, high = extent_ - low;
        const Vec3 q = position - origin_;
        return q.x >= low && q.y >= low && q.z >= low && q.x <= high && q.y <= high && q.z <= high;
    }

    /// A point of `region` moved by up to half the region's size along each axis, for the stochastic spatial filter of
    /// the authors' improved program. `random`: three uniform 32-bit numbers.
    Vec3 jittered(const Vec3& position, std::uint32_t region, const Draw& random) const {
        const Vec3& size = region_size_[region_depth_[region]];
        return {position.x + size.x * (to_unit(random[0]) - 0.5f), position.y + size.y * (to_unit(random[1]) - 0.5f),
                position.z + size.z * (to_unit(random[2]) - 0.5f)};
    }

  protected:
    std::size_t region_bytes() const;

    std::vector<std::int16_t> quantum_exponent_;
    std::vector<float> bsdf_fraction_;

  private:
    static constexpr std::uint32_t kLeafFlag = 0x80000000u;

    std::uint32_t build_treelet(const RegionModel& model, std::uint32_t node, int depth);
    void build_top();

    bool trained_ = false;
    Vec3 origin_{0.0f};
    float inverse_extent_ = 1.0f;
    float extent_ = 1.0f;
    std::vector<std::array<std::uint32_t, 8>> treelets_;
    std::vector<std::uint32_t> top_;  ///< entry that kTopBits treelets lead to, or a leaf above
    std::vector<LightProbabilities> light_probabilities_;
    std::vector<float> flux_;
    std::vector<std::uint8_t> next_event_;
    ImageFacts image_;
    bool thins_next_event_ = false;
    std::vector<std::uint8_t> region_depth_;                ///< halvings from the cube to the region
    std::array<Vec3, kMaxSpatialDepth + 1> region_size_{};  ///< per depth, in scene units
};

}  // namespace treefarm
