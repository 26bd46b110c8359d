// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "worker/integrators/path/path_events.h"

namespace treefarm {

/// Finder of the largest contribution to a sample and of its origin.
class OriginFinder : public PathEvents {
  public:
    /// Origin of the largest contribution; without vertices if there is none.
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
    /// History of a path up to its present vertex.
    struct PassedSurfaces {
        PathClass last = PathClass::diffuse;
        bool scattered = false;  ///< at a surface other than mirrors and smooth glass

        void pass(const SurfacePassage& surface);
    };

    void found(LightFound how, const PassedSurfaces& passed, int vertices, const Rgb& contribution);

    PassedSurfaces passed_;
    int depth_ = 0;
    bool left_scene_ = false;
    Vec3 view_{0.0f}, first_normal_{0.0f};  ///< the camera ray's direction; geometric normal at its hit
    std::vector<PassedSurfaces> waiting_;   ///< of paths that were split off, in their order
    std::size_t taken_ = 0;                 ///< number of them that have been traced
    float largest_ = 0.0f;
    LightOrigin origin_;
};

}  // namespace treefarm
