// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/base/random.h"
#include "common/scene/model/scene.h"
#include "worker/geometry/embree_scene.h"
#include "worker/lights/area.h"
#include "worker/lights/delta_light.h"
#include "worker/lights/direct_sample.h"
#include "worker/lights/discrete_table.h"
#include "worker/lights/emission_sample.h"
#include "worker/lights/environments.h"
#include "worker/lights/light_batch.h"

namespace treefarm {

/// All emitters of a scene: what they emit, and how next event samples them. Emitters are chosen by power, none less
/// often than a thousandth of its even share; points on meshes, disks and cylinders uniformly by area, spheres by the
/// cone they fill, a constant environment uniformly over the sphere of directions, an image by its luminance.
/// Immutable. `geometry` and `textures` must outlive it.
class Emitters {
  public:
    /// `bounds` is the box of the scene: it sets the power of what comes from infinity. Throws RunError if an emitter
    /// needs textures that are not there.
    Emitters(const std::vector<Emitter>& emitters, const EmbreeScene& geometry, const Box3& bounds,
             const TextureSet* textures = nullptr);

    /// False if nothing emits: there is nothing to sample.
    bool can_sample() const { return !selection_.empty(); }

    /// Whether environment() may be other than black.
    bool shines_from_infinity() const { return shines_from_infinity_; }

    /// Samples a direction from p. random[0] chooses the emitter, [1] the triangle, [2] and [3] the place; for an
    /// environment's image [1] and [2] the texel, [3] the place about it. What comes from infinity has no radiance yet:
    /// environment() is to be asked once it is known to be seen. `share`: how clusters of emitters are chosen; nullptr:
    /// all by power. `front`: normal of a surface at p that reflects only; what is behind it, or turns its back on p,
    /// may be no sample then, where that is found out before it costs much. nullptr: every sample has its density.
    DirectSample sample_direct(const Vec3& p, const Draw& random, const LightProbabilities* probabilities = nullptr,
                               const Vec3* front = nullptr) const;

    /// Whether there is a gain in drawing many together.
    bool draws_together() const { return has_spheres_ || has_map(); }
    // The same for many: clear the batch, choose() for all lanes that may sample, draw(), and sample_direct() for those
    // that do, each from the place, with the numbers and the share of its choice. A density from the environment map is
    // still to be asked for, as radiance is: 1 stands for it.
    void choose(LightBatch& batch, std::uint32_t lane, const Vec3& p, const Draw& random,
                const LightProbabilities* probabilities) const;
    void draw(LightBatch& batch) const;
    DirectSample sample_direct(const Vec3& p, const LightBatch& batch, std::uint32_t lane, const Draw& random,
                               const LightProbabilities* probabilities, const Vec3* front) const;
    /// Whether some may be of an environment map.
    bool has_map() const { return environments_.map().shines(); }
    /// Radiance from infinity against a direction of such a sample.
    Rgb environment(const LightBatch& batch, std::uint32_t lane, const Vec3& direction) const;
    /// Density of such a sample, for which sample_direct() gave `pdf`.
    float environment_pdf(const LightBatch& batch, std::uint32_t lane, float pdf,
                          const LightProbabilities* probabilities) const;
    /// Fetches what both read.
    void prefetch_environment(const LightBatch& batch, std::uint32_t lane) const;
    /// Clusters that next event can learn to choose among.
    const LightClusters& clusters() const { return clusters_; }

    /// Lights without extent, which nothing but sampling them finds.
    bool has_delta_lights() const { return !delta_lights_.empty(); }
    /// A sample as sample_direct() draws it, of the lights without extent alone.
    DirectSample sample_delta(const Vec3& p, const Draw& random) const;

    /// Density per steradian with which sample_direct(p) finds `hit` along the unit direction wi; 0 if it never does.
    float pdf_direct(const Vec3& p, const Vec3& wi, const Hit& hit,
                     const LightProbabilities* probabilities = nullptr) const;

    /// A ray that leaves an emitter, chosen by power as next event does: the beginning of a light path. `place` chooses
    /// where it starts, as the numbers of sample_direct() do, or the direction that it comes from if that is from
    /// infinity; direction[0] and [1] its direction, or the place across that one. A scene without surfaces gets none.
    EmissionSample emit(const Draw& place, const Draw& direction) const;
    /// Densities with which emit() starts at a point of an area emitter into the unit direction `away`; zeros where
    /// nothing shines.
    EmissionDensity emission_density(const Hit& start, const Vec3& away) const;
    /// Densities of light from infinity that comes against the unit `direction`.
    EmissionDensity emission_density(const Vec3& direction) const;
    /// Densities with which emit() starts where next event ended, which drew `sample` by these numbers; `delta_alone`:
    /// by sample_delta().
    EmissionDensity emission_density(const DirectSample& sample, const Draw& random, bool delta_alone) const;
    /// Density with which sample_direct() at p finds the start of a light path, in the measure of its place_pdf.
    double next_event_pdf(const EmissionSample& start, const Vec3& p) const;

    /// Whether emitted() may be other than black on a shape.
    bool emits(std::uint32_t shape) const { return light_of_shape_[shape] != kNone; }

    /// Radiance that leaves a surface point into the direction `wo`.
    Rgb emitted(const Hit& hit, const Vec3& wo) const {
        const std::int32_t light = light_of_shape_[hit.shape];
        if (light == kNone || !(dot(hit.ng, wo) > 0.0f)) return Rgb(0.0f);
        const AreaLight& area = area_lights_[static_cast<std::size_t>(light)];
        if (area.texture != kNone) [[unlikely]]
            return area.textured(scene_, hit).rgb();
        return area.radiance;
    }

    /// Radiance that comes from infinity, against the unit `direction`.
    Rgb environment(const Vec3& direction) const { return environments_.radiance(direction); }

    /// Density of sample_direct() for directions in which nothing is hit.
    float pdf_environment(const Vec3& direction, const LightProbabilities* probabilities = nullptr) const {
        return environments_.pdf(direction, clusters_, probabilities);
    }

  private:
    /// Returns its power.
    double add_area_light(const AreaEmitter& emitter);
    void select(std::vector<double> power);
    EmissionSample emit_from_area(const AreaLight& light, const Draw& place, const Draw& direction) const;
    EmissionSample emit_from_infinity(std::uint32_t entry, const Draw& place, const Draw& direction) const;
    /// Kept out of line, so that plain meshes pay nothing for the other kinds.
    [[gnu::noinline]] DirectSample sample_other(std::uint32_t entry, const Vec3& p, const Draw& random,
                                                const LightProbabilities* probabilities, const Vec3* front) const;
    DirectSample sample_without_area(std::uint32_t entry, const Vec3& p, const Draw& random,
                                     const LightProbabilities* probabilities, const Vec3* front) const;
    float map_pdf(const EnvironmentSample& drawn, const LightProbabilities* probabilities) const;
    ChosenEmitter choose(const Draw& random, const LightProbabilities* probabilities) const {
        const auto cluster =
            probabilities ? clusters_.pick(*probabilities, random[0]) : LightClusters::Choice{0, random[0], 1.0f, 1.0f};
        return {selection_.pick(cluster.bits), cluster};
    }
    DirectSample sample(const ChosenEmitter& chosen, const Vec3& p, const Draw& random,
                        const LightProbabilities* probabilities, const Vec3* front) const;
    /// Whether an entry of the table is a part of the environment map.
    bool is_map(std::uint32_t entry) const { return environments_.is_map(entry); }
    /// That of the table's entry, if it is a sphere.
    const AreaLight* sphere_light(std::uint32_t entry) const {
        return entry < area_lights_.size() && area_lights_[entry].sphere ? &area_lights_[entry] : nullptr;
    }

    LightScene scene_;
    std::vector<AreaLight> area_lights_;
    std::vector<std::int32_t> light_of_shape_;
    std::vector<DeltaLight> delta_lights_;
    std::vector<float> delta_selection_;  ///< probability that each is chosen
    DiscreteTable delta_alone_;           ///< over delta lights
    DiscreteTable selection_;             ///< over area lights, delta lights, parts of environments
    LightClusters clusters_;              ///< of its entries
    Environments environments_;
    SceneBall ball_;
    bool shines_from_infinity_ = false;
    bool has_spheres_ = false;  ///< among area lights
};

}  // namespace treefarm
