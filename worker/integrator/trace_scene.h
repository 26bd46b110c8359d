#pragma once

#include <string>
#include <vector>

#include "common/config/job.h"
#include "common/scene/scene.h"
#include "worker/integrator/camera_rays.h"
#include "worker/lights/emitters.h"
#include "worker/shading/bsdf.h"

namespace treefarm {

/// The scene ready for tracing. Immutable after construction: one per process, shared by its threads.
class TraceScene {
  public:
    /// Builds the hierarchy and the light tables; the film is the scene's. Throws RunError where Embree fails.
    TraceScene(Scene scene, const Job& job);

    const EmbreeScene& geometry() const { return geometry_; }
    const Emitters& emitters() const { return emitters_; }
    const CameraRays& camera() const { return camera_; }
    const TextureSet& textures() const { return textures_; }
    const Film& film() const { return film_; }
    const Bsdf& bsdf(std::uint32_t shape) const { return bsdfs_[shape]; }

  private:
    /// `opacity` as in ShapeMasks. Takes the scene apart.
    TraceScene(Scene&& scene, const std::vector<FloatInput>& opacity, const Job& job);

    Film film_;
    CameraRays camera_;
    std::vector<Bsdf> bsdfs_;  ///< per shape
    Box3 bounds_;
    TextureSet textures_;
    EmbreeScene geometry_;
    Emitters emitters_;
};

}  // namespace treefarm
