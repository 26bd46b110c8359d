// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/base/random.h"
#include "common/guiding/regions/region_model.h"
#include "common/math/level_block.h"
#include "common/math/next_event_sums.h"
#include "common/math/vector_batch.h"

namespace treefarm {

/// The regions in the form that workers look them up in: 8-way spatial treelets below a table (bench/guide_bench.cpp
/// shows why), and what is shared of each. Every guide's sampler begins with it. Immutable; one per process, shared by
/// its threads.
class RegionSampler {
  public:
    explicit RegionSampler(const RegionModel& model);

    /// False in the first pass: nothing was learned yet, sample the BSDF alone.
    bool trained() const { return trained_; }
    /// What records are counted for: regions, and what a guide may have besides.
    std::uint32_t distribution_count() const { return static_cast<std::uint32_t>(quantum_exponent_.size()); }
    std::uint32_t region_count() const { return static_cast<std::uint32_t>(region_depth_.size()); }
    std::int16_t quantum_exponent(std::uint32_t distribution) const { return quantum_exponent_[distribution]; }
    /// Probability of sampling the BSDF rather than the guide where `distribution` is the finest that there is.
    float bsdf_fraction(std::uint32_t distribution) const { return bsdf_fraction_[distribution]; }

    /// Whether next event learns how to choose emitters.
    bool learns_lights() const { return !light_probabilities_.empty(); }
    /// What is learned of emitters in a region; nullptr: nothing.
    const LightProbabilities* light_probabilities(std::uint32_t region) const {
        return light_probabilities_.empty() ? nullptr : &light_probabilities_[region];
    }

    /// Light samples per vertex of a region, and of an image that nothing guides.
    float next_event(std::uint32_t region) const {
        return next_event_.empty() ? 1.0f : kNextEventSamples[next_event_[region]];
    }
    float image_next_event() const { return kNextEventSamples[image_.next_event]; }
    bool decides_next_event() const { return !next_event_.empty(); }
    /// Whether any vertex may have fewer light samples than one.
    bool thins_next_event(bool by_region) const { return by_region ? thins_next_event_ : image_.next_event != 0; }
    /// Whether the image is known, by which light is judged; one over the light about a pixel of it.
    bool knows_image() const { return !image_.inverse_levels.empty(); }
    float inverse_level(std::uint32_t x, std::uint32_t y) const {
        const std::size_t block = level_block(x, y, image_.columns);
        return block < image_.inverse_levels.size() ? image_.inverse_levels[block] : 0.0f;
    }

    /// Integral of the radiance that a region has learned, over directions; 0: nothing is known of it.
    float flux(std::uint32_t region) const { return flux_.empty() ? 0.0f : flux_[region]; }

    /// The region of a point. Points outside the cube belong to the nearest region (the caller may count them with
    /// contains()).
    std::uint32_t region(const Vec3& position) const;
    /// The regions of the first `count` points, in step: what one waits for (memory, how deep the tree is there)
    /// another works through.
    void regions(const VectorBatch& positions, std::uint32_t count, std::array<std::uint32_t, kDrawBatch>& found) const;
    bool contains(const Vec3& position) const {
        // Points of the outermost surfaces may lie a rounding error outside.
        const float low = -1e-4f * extent_, high = extent_ - low;
        const Vec3 q = position - origin_;
        return q.x >= low && q.y >= low && q.z >= low && q.x <= high && q.y <= high && q.z <= high;
    }

    /// A point of `region` moved by up to half the region's size along each axis: where the stochastic spatial filter
    /// of the authors' improved program looks for a record's region. Three uniform 32-bit numbers.
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
    std::vector<std::uint32_t> top_;  ///< the entries that kTopBits treelets lead to, or the leaf before
    std::vector<LightProbabilities> light_probabilities_;
    std::vector<float> flux_;
    std::vector<std::uint8_t> next_event_;
    ImageFacts image_;
    bool thins_next_event_ = false;
    std::vector<std::uint8_t> region_depth_;                ///< halvings from the cube to the region
    std::array<Vec3, kMaxSpatialDepth + 1> region_size_{};  ///< per depth, in scene units
};

}  // namespace treefarm
