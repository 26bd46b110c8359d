// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "common/plan/effects/scene_effects.h"
#include "common/plan/resolve/resolve.h"
#include "common/scene/model/scene.h"
#include "worker/camera/camera_rays.h"
#include "worker/lights/emitters.h"
#include "worker/shading/material_set.h"
#include "worker/shading/plain_diffuse.h"

namespace treefarm {

/// A scene prepared for tracing. Immutable after construction: one per process, shared by its threads.
class TraceScene {
  public:
    /// Builds the hierarchy and the light tables; the film is the scene's. Throws RunError if Embree fails, or if the
    /// scene needs an effect that the program was built without.
    TraceScene(Scene scene, const Resolved& job);

    const EmbreeScene& geometry() const { return geometry_; }
    const Emitters& emitters() const { return emitters_; }
    const CameraRays& camera() const { return camera_; }
    const TextureSet& textures() const { return textures_; }
    const Film& film() const { return film_; }
    /// Box of all shapes.
    const Box3& bounds() const { return bounds_; }
    /// Effects that the scene needs: for assertions, not for decisions.
    const SceneEffects& effects() const { return effects_; }
    /// Whether plain_diffuse() holds every material; if not, materials() does.
    bool plainly_diffuse() const { return !materials_; }
    const PlainDiffuse& plain_diffuse(std::uint32_t shape) const { return plain_diffuse_[shape]; }
    const MaterialSet& materials() const { return *materials_; }

  private:
    /// `masks`: without textures. Moves the scene's parts out.
    TraceScene(Scene&& scene, ShapeMasks masks, const Resolved& job);

    SceneEffects effects_;
    Film film_;
    CameraRays camera_;
    Box3 bounds_;
    TextureSet textures_;
    std::vector<PlainDiffuse> plain_diffuse_;  ///< per shape
    std::optional<MaterialSet> materials_;
    EmbreeScene geometry_;
    Emitters emitters_;
};

}  // namespace treefarm
