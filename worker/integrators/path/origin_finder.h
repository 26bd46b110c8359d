// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "worker/integrators/path/path_events.h"

namespace treefarm {

/// Finds out where the largest contribution to a sample comes from.
class OriginFinder : public PathEvents {
  public:
    /// Nothing found is an origin without vertices.
    const LightOrigin& origin() const { return origin_; }

    void camera(const Ray& ray) override;
    void arrive(int depth, const Hit* hit) override;
    void emission(const Rgb& radiance, float light_pdf, float weight, const Rgb& contribution) override;
    void scatter(const SurfacePassage& passage, const ScatterSample& s, const Rgb& throughput) override;
    void next_event(const SurfacePassage& passage, const SampledLight& light, float scatter_pdf, float weight,
                    const Rgb& contribution) override;
    void other_branch(const Ray& ray, const Rgb& throughput) override;
    void split(std::uint32_t paths, const Rgb& throughput) override;
    void split_path(const SplitPath& path) override;

  private:
    /// What a path has passed so far.
    struct PassedSurfaces {
        PathClass last = PathClass::diffuse;
        bool scattered = false;  ///< not only by mirrors and smooth glass

        void pass(const SurfacePassage& surface);
    };

    void found(LightFound how, const PassedSurfaces& passed, int vertices, const Rgb& contribution);

    PassedSurfaces passed_;
    int depth_ = 0;
    bool left_scene_ = false;
    Vec3 view_{0.0f}, first_normal_{0.0f};  ///< the camera ray's direction; where it arrived
    std::vector<PassedSurfaces> waiting_;   ///< of paths that were split off
    std::size_t taken_ = 0;                 ///< of them
    float largest_ = 0.0f;
    LightOrigin origin_;
};

}  // namespace treefarm
