// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "worker/geometry/embree_scene.h"
#include "worker/integrators/unit_output.h"

namespace treefarm {

/// SampleConnections of one sample, whose shadow rays wait for each other: many together are faster. They are added up
/// in the order in which they were made.
class SampleConnections {
  public:
    SampleConnections(const EmbreeScene& geometry, UnitOutput& output) : geometry_(geometry), output_(output) {}

    /// One that brings light to the sample's own pixel.
    void add(const Ray& ray, const Rgb& value) { add(ray, {value, kOwn, 0}); }
    /// One that brings light to any, from so numbered a vertex of the light path.
    void add_splat(const Ray& ray, const Rgb& value, std::uint32_t pixel, std::uint32_t vertex) {
        add(ray, {value, pixel, vertex});
    }

    /// Splats what reaches other pixels, and returns what reaches the sample's own. None is left.
    Rgb finish(const PathKey& key) {
        Rgb sum(0.0f);
        for (std::size_t begin = 0; begin < rays_.size(); begin += EmbreeScene::kMostTogether) {
            const std::size_t count = std::min(rays_.size() - begin, EmbreeScene::kMostTogether);
            geometry_.occluded({&rays_[begin], count}, hidden_.data());
            for (std::size_t i = 0; i < count; ++i) {
                const Carried& carried = carried_[begin + i];
                if (hidden_[i]) continue;
                if (carried.pixel == kOwn)
                    sum += carried.value;
                else
                    output_.splats.add(carried.pixel, key.sample, carried.value,
                                       draw(key, carried.vertex, Stream::splat_round));
            }
        }
        output_.stats.shadow_rays += rays_.size();
        rays_.clear();
        carried_.clear();
        return sum;
    }

  private:
    static constexpr std::uint32_t kOwn = ~0u;

    struct Carried {
        Rgb value;
        std::uint32_t pixel, vertex;
    };

    void add(const Ray& ray, const Carried& carried) {
        rays_.push_back(ray);
        carried_.push_back(carried);
    }

    const EmbreeScene& geometry_;
    UnitOutput& output_;
    std::vector<Ray> rays_;
    std::vector<Carried> carried_;
    std::array<bool, EmbreeScene::kMostTogether> hidden_{};
};

}  // namespace treefarm
