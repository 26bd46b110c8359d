// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "common/film/aov_film.h"
#include "common/film/work_unit.h"
#include "common/plan/schedule/schedule.h"
#include "common/scene/model/scene.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Surfaces that are looked through, at most, for the first one that is no mirror and no smooth glass.
inline constexpr std::uint32_t kMostSmoothSurfaces = 64;

/// Fills the AOVs that a camera ray decides by what it meets (docs/use/outputs.md), beside any integrator: its rays are
/// those of the integrator's paths, since random numbers are keyed. A pure function of scene, seed and unit.
class FirstHitRenderer {
  public:
    /// `camera`: the scene's.
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
    Vec3 eye_, axis_;  ///< where depth is measured from, and along which unit vector
};

/// Unit vector along which a camera looks: normal to the plane of its film; 0 for a panorama, whose depth is distance.
Vec3 camera_axis(const Camera& camera);

}  // namespace treefarm
