#pragma once

#include <vector>

#include "common/base/random.h"
#include "common/scene/scene.h"
#include "worker/geometry/embree_scene.h"
#include "worker/lights/discrete_table.h"
#include "worker/lights/sphere_cone.h"

namespace treefarm {

/// A direction in which an emitter was sampled from a point.
struct DirectSample {
    Vec3 wi{0.0f};       ///< unit, towards the emitter
    float distance = 0;  ///< infinite for the environment
    float pdf = 0;       ///< per steradian, choice of the emitter included; 0: no sample
    Rgb radiance{0.0f};  ///< that leaves the emitter against wi, occlusion aside; black on the back
    Hit on_light;        ///< the sampled point; meaningless for the environment

    bool to_environment() const { return std::isinf(distance); }
};

/// All emitters of a scene: what they emit, and how next event samples them. Emitters are chosen by power; points on
/// meshes uniformly by area, spheres by the cone they fill, the environment uniformly over the sphere of directions.
/// Immutable. `geometry` must outlive it.
class Emitters {
  public:
    /// `bounds` is the box of the scene: it sets the power of the environment.
    Emitters(const std::vector<Emitter>& emitters, const EmbreeScene& geometry, const Box3& bounds);

    /// False if nothing emits: there is nothing to sample.
    bool can_sample() const { return !selection_.empty(); }

    /// Samples a direction from p. random[0] chooses the emitter, [1] the triangle, [2] and [3] the place.
    DirectSample sample_direct(const Vec3& p, const Draw& random) const;

    /// Density per steradian with which sample_direct(p) finds `hit` along the unit direction wi; 0 if it never does.
    float pdf_direct(const Vec3& p, const Vec3& wi, const Hit& hit) const;

    /// The same for directions in which nothing is hit.
    float pdf_environment() const { return environment_pdf_; }

    /// Radiance that leaves a surface point into the direction `wo`.
    Rgb emitted(const Hit& hit, const Vec3& wo) const {
        const std::int32_t light = light_of_shape_[hit.shape];
        if (light == kNone || !(dot(hit.ng, wo) > 0.0f)) return Rgb(0.0f);
        return area_lights_[static_cast<std::size_t>(light)].radiance;
    }

    const Rgb& environment() const { return environment_; }

  private:
    /// Probabilities of a mesh's triangles and, per triangle, the resulting density per area.
    struct AreaLight {
        Rgb radiance{0.0f};
        std::uint32_t shape = 0;
        const Sphere* sphere = nullptr;
        float selection = 0;              ///< probability that this light is chosen
        DiscreteTable triangles;          ///< meshes
        std::vector<float> area_density;  ///< meshes: per area, within this light
    };

    double add_area_light(const AreaEmitter& emitter, const EmbreeScene& geometry);
    DirectSample sample_mesh(const AreaLight& light, const Vec3& p, const Draw& random) const;
    DirectSample sample_sphere(const AreaLight& light, const Vec3& p, const Draw& random) const;
    DirectSample sample_environment(const Draw& random) const;

    const EmbreeScene* geometry_;
    std::vector<AreaLight> area_lights_;
    std::vector<std::int32_t> light_of_shape_;
    DiscreteTable selection_;  ///< over the area lights, then the environment
    Rgb environment_{0.0f};
    float environment_pdf_ = 0;
};

}  // namespace treefarm
