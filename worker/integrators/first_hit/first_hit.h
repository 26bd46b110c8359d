// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/film/aov_film.h"
#include "common/film/work_unit.h"
#include "common/plan/schedule/schedule.h"
#include "common/scene/model/scene.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Limit of mirrors and smooth glass that a camera ray follows to the first other surface.
inline constexpr std::uint32_t kMostSmoothSurfaces = 64;

/// Renderer of the AOVs that a camera ray's first hit determines (docs/use/outputs.md), beside any integrator. Its rays
/// equal those of the integrator's paths, since random numbers are keyed. A pure function of scene, seed and unit.
class FirstHitRenderer {
  public:
    /// Requires `camera` to be the scene's.
    FirstHitRenderer(std::shared_ptr<const TraceScene> scene, const Camera& camera, std::uint64_t seed,
                     const AovLayout& layout);

    /// Thread-safe for different outputs.
    void render(const PassPlan& pass, const WorkUnit& unit, AovPixels& output) const;

  private:
    template <class Surface>
    void render_unit(const PassPlan& pass, const WorkUnit& unit, AovPixels& output) const;

    std::shared_ptr<const TraceScene> scene_;
    std::uint64_t seed_;
    AovLayout layout_;
    Vec3 eye_, axis_;  ///< origin and unit axis of the depth measurement
};

/// Viewing direction of a camera: unit normal of its film plane; 0 for a panorama, whose depth is distance.
Vec3 camera_axis(const Camera& camera);

}  // namespace treefarm
