// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "worker/geometry/embree_scene.h"
#include "worker/integrators/unit_output.h"

namespace treefarm {

/// Connections of one sample. Their shadow rays are collected, since many together are faster; contributions are added
/// in the order in which they were made.
class SampleConnections {
  public:
    SampleConnections(const EmbreeScene& geometry, UnitOutput& output) : geometry_(geometry), output_(output) {}

    /// Sums over the unoccluded connections of a sample.
    struct Sums {
        Rgb own{0.0f};           ///< contribution to the sample's own pixel
        double alone = 0;        ///< luminance that next event would bring without the light path
        double from_lights = 0;  ///< luminance that the light path's vertices contribute to the sample's own pixel
        double splats = 0, splat_squares = 0;  ///< contributions to other pixels: sums of luminance and of its square
    };

    /// Adds a connection of a light subpath's vertex to the sample's own pixel.
    void add(const Ray& ray, const Rgb& value) { add(ray, {value, 0.0, kOwn, 0}); }
    /// Adds a connection of a sampled emitter to the sample's own pixel; `alone`: its luminance without the light path.
    void add_direct(const Ray& ray, const Rgb& value, double alone) { add(ray, {value, alone, kDirect, 0}); }
    /// Adds a connection of the light subpath's vertex number `vertex` to any pixel.
    void add_splat(const Ray& ray, const Rgb& value, std::uint32_t pixel, std::uint32_t vertex) {
        add(ray, {value, 0.0, pixel, vertex});
    }

    /// Traces the shadow rays, splats contributions to other pixels, and returns the sums. Clears the connections.
    Sums finish(const Numbers auto& numbers) {
        Sums sums;
        for (std::size_t begin = 0; begin < rays_.size(); begin += EmbreeScene::kMostTogether) {
            const std::size_t count = std::min(rays_.size() - begin, EmbreeScene::kMostTogether);
            geometry_.occluded({&rays_[begin], count}, hidden_.data());
            for (std::size_t i = 0; i < count; ++i) {
                const Carried& carried = carried_[begin + i];
                if (hidden_[i]) continue;
                if (carried.pixel >= kDirect) {
                    sums.own += carried.value;
                    sums.alone += carried.alone;
                    if (carried.pixel == kOwn) sums.from_lights += luminance(carried.value);
                    continue;
                }
                output_.splats.add(carried.pixel, numbers.sample, carried.value,
                                   draw(numbers, carried.vertex, Stream::splat_round));
                const double splat = luminance(carried.value);
                sums.splats += splat;
                sums.splat_squares += splat * splat;
            }
        }
        output_.stats.shadow_rays += rays_.size();
        rays_.clear();
        carried_.clear();
        return sums;
    }

  private:
    static constexpr std::uint32_t kOwn = ~0u, kDirect = kOwn - 1;  // no film has so many pixels

    struct Carried {
        Rgb value;
        double alone;
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
