// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "common/base/random.h"
#include "common/scene/model/scene.h"
#include "worker/geometry/embree_scene.h"
#include "worker/lights/area.h"
#include "worker/lights/delta_light.h"
#include "worker/lights/direct_sample.h"
#include "worker/lights/discrete_table.h"
#include "worker/lights/emission_choice.h"
#include "worker/lights/emission_sample.h"
#include "worker/lights/environments.h"
#include "worker/lights/light_batch.h"
#include "worker/lights/light_choice.h"

namespace treefarm {

/// All emitters of a scene: what they emit, and how next event samples them. Emitters are chosen by power, none less
/// often than a thousandth of its even share, or as LightChoice says; points on meshes, disks and cylinders uniformly
/// by area, spheres by the cone they fill, a constant environment uniformly over the sphere of directions, an image by
/// its luminance. Immutable. `geometry` and `textures` must outlive it.
class Emitters {
  public:
    /// `bounds` is the box of the scene: it sets the power of what comes from infinity. Throws RunError if an emitter
    /// needs textures that are not there.
    Emitters(const std::vector<Emitter>& emitters, const EmbreeScene& geometry, const Box3& bounds,
             const TextureSet* textures = nullptr, LightSelection how = LightSelection::power);

    /// False if nothing emits: there is nothing to sample.
    bool can_sample() const { return !selection_.empty(); }

    /// Whether environment() may be other than black.
    bool shines_from_infinity() const { return shines_from_infinity_; }

    /// Samples a direction from p. random[0] chooses the emitter, [1] the triangle, [2] and [3] the place; for an
    /// environment's image [1] and [2] the texel, [3] the place about it. What comes from infinity has no radiance yet:
    /// environment() is to be asked once it is known to be seen. `probabilities`: what is learned at p of emitters;
    /// nullptr: nothing is. `front`: normal of a surface at p that reflects only; emitters behind it may be chosen less
    /// often, or never; what is behind it, or turns its back on p, may be no sample then, where that is found out
    /// before it costs much. nullptr: every sample has its density.
    DirectSample sample_direct(const Vec3& p, const Draw& random, const LightProbabilities* probabilities = nullptr,
                               const Vec3* front = nullptr) const {
        return sample_direct(LightReceiver(p, probabilities, front), random);
    }
    DirectSample sample_direct(const LightReceiver& receiver, const Draw& random) const;

    /// Whether there is a gain in drawing many together.
    bool draws_together() const { return has_spheres_ || has_map() || choice_.flat(); }
    // The same for many: clear the batch, choose() for all lanes that may sample, draw(), and sample_direct() for those
    // that do, each with the numbers of its choice. A density from the environment map is still to be
    // asked for, as radiance is: 1 stands for it.
    void choose(LightBatch& batch, std::uint32_t lane, const LightReceiver& receiver, const Draw& random) const;
    void draw(LightBatch& batch) const;
    DirectSample sample_direct(const LightBatch& batch, std::uint32_t lane, const Draw& random) const;
    /// Keeps what was found out of emitters where a lane chose one, so that densities there need not find out again; in
    /// `storage`, which must last as long as `receiver`.
    void keep(const LightBatch& batch, std::uint32_t lane, LightReceiver& receiver, LightWidthStore& storage) const {
        const FlatLights* const few = choice_.flat();
        if (!few) return;
        batch.flat.copy_widths(lane, storage.data(), few->count());
        receiver.widths = storage.data();
    }
    /// Whether some may be of an environment map.
    bool has_map() const { return environments_.map().shines(); }
    /// Radiance from infinity against a direction of such a sample.
    Rgb environment(const LightBatch& batch, std::uint32_t lane, const Vec3& direction) const;
    /// Density of such a sample, for which sample_direct() gave `pdf`.
    float environment_pdf(const LightBatch& batch, std::uint32_t lane, float pdf) const;
    /// Fetches what both read.
    void prefetch_environment(const LightBatch& batch, std::uint32_t lane) const;
    /// How next event chooses.
    const LightChoice& choice() const { return choice_; }

    /// Lights without extent, which nothing but sampling them finds.
    bool has_delta_lights() const { return !delta_lights_.empty(); }
    /// A sample as sample_direct() draws it, of the lights without extent alone.
    DirectSample sample_delta(const Vec3& p, const Draw& random) const;

    /// Density per steradian with which sample_direct(p) finds `hit` along the unit direction wi; 0 if it never does.
    /// `probabilities` and `front` as there: the same, or the weights of the two do not sum to one.
    float pdf_direct(const Vec3& p, const Vec3& wi, const Hit& hit, const LightProbabilities* probabilities = nullptr,
                     const Vec3* front = nullptr) const {
        return pdf_direct(LightReceiver(p, probabilities, front), wi, hit);
    }
    float pdf_direct(const LightReceiver& receiver, const Vec3& wi, const Hit& hit) const;

    /// How a pass of this emphasis (emission_shares.h) chooses emitters for light paths; empty: by power. Throws
    /// RunError where it is of other emitters.
    EmissionChoice emission_choice(std::span<const float> emphasis = {}) const {
        return EmissionChoice(selection_, emphasis);
    }
    // `choice` in what follows: nullptr is by power; whoever asks for one path's densities gives the same.
    /// A ray that leaves an emitter, chosen without regard to what next event does: the beginning of a light path.
    /// `place` chooses where it starts, as the numbers of sample_direct() do, or the direction that it comes from if
    /// that is from infinity; direction[0] and [1] its direction, or the place across that one. A scene without
    /// surfaces gets none.
    EmissionSample emit(const Draw& position, const Draw& direction, const EmissionChoice* choice = nullptr) const;
    /// Densities with which emit() starts at a point of an area emitter into the unit direction `away`; zeros where
    /// nothing shines.
    EmissionDensity emission_density(const Hit& start, const Vec3& away, const EmissionChoice* choice = nullptr) const;
    /// Densities of light from infinity that comes against the unit `direction`.
    EmissionDensity emission_density(const Vec3& direction, const EmissionChoice* choice = nullptr) const;
    /// Densities with which emit() starts where next event ended, which drew `sample` at `receiver` by these numbers;
    /// `delta_alone`: by sample_delta().
    EmissionDensity emission_density(const DirectSample& sample, const LightReceiver& receiver, const Draw& random,
                                     bool delta_alone, const EmissionChoice* choice = nullptr) const;
    /// Density with which sample_direct() at `receiver` finds the start of a light path, in the measure of its
    /// position_pdf.
    double next_event_pdf(const EmissionSample& start, const LightReceiver& receiver) const;

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

    /// Density of sample_direct(p) for directions in which nothing is hit, as pdf_direct().
    float pdf_environment(const Vec3& p, const Vec3& direction, const LightProbabilities* probabilities = nullptr,
                          const Vec3* front = nullptr) const {
        return pdf_environment(LightReceiver(p, probabilities, front), direction);
    }
    float pdf_environment(const LightReceiver& receiver, const Vec3& direction) const {
        return environments_.pdf(direction, probabilities_at(receiver));
    }

  private:
    /// Returns its power.
    double add_area_light(const AreaEmitter& emitter);
    void select(std::vector<double> power, LightSelection how);
    /// Lets next event choose among patches of area lights and all others, of that power each, by place.
    void select_by_point(std::span<const double> power, LightSelection how);

    /// A patch of an area light.
    struct AreaEntry {
        std::uint32_t light, patch;
    };
    /// Whether next event's entry is one of them, and which.
    bool is_area(std::uint32_t entry) const { return entry < area_entries_; }
    AreaEntry area_entry(std::uint32_t entry) const {
        if (light_of_entry_.empty()) return {entry, 0};
        const std::uint32_t light = light_of_entry_[entry];
        return {light, entry - first_entry_[light]};
    }
    /// Next event's entry of what was hit.
    std::uint32_t entry_of(std::uint32_t light, const Hit& hit) const {
        return light_of_entry_.empty() ? light : first_entry_[light] + area_lights_[light].patch_of(hit);
    }
    EmissionSample emit_by(const EmissionChoice& choice, const Draw& position, const Draw& direction) const;
    EmissionSample emit_from_area(const AreaLight& light, float selection, const Draw& position,
                                  const Draw& direction) const;
    EmissionSample emit_from_point(std::size_t index, float selection, const Draw& direction) const;
    EmissionSample emit_from_infinity(std::uint32_t entry, const Draw& position, const Draw& direction,
                                      const EmissionChoice& choice) const;
    EmissionProbabilities emission_probabilities(const EmissionChoice* choice) const {
        return {choice, area_entries_ - static_cast<std::uint32_t>(area_lights_.size())};
    }
    /// Kept out of line, so that plain meshes pay nothing for the other kinds.
    [[gnu::noinline]] DirectSample sample_other(const LightPick& chosen, const LightReceiver& receiver,
                                                const Draw& random) const;
    DirectSample sample_without_area(const LightPick& chosen, const LightReceiver& receiver, const Draw& random) const;
    EntryProbabilities probabilities_at(const LightReceiver& receiver, const LightPick& known = {}) const {
        if (choice_.by_power()) return {};
        return {&choice_, &receiver, known};
    }
    DirectSample sample(const LightPick& chosen, const LightReceiver& receiver, const Draw& random) const;
    /// Asks for what is drawn together of the emitter that a lane has chosen.
    void file(LightBatch& batch, std::uint32_t lane) const;
    /// Whether next event's entry is a part of the environment map.
    bool is_map(std::uint32_t entry) const { return environments_.is_map(entry); }
    /// The light that next event's entry names, if it is a sphere that shines; otherwise nullptr.
    const AreaLight* sphere_light(std::uint32_t entry) const {
        if (!is_area(entry)) return nullptr;
        const AreaLight& light = area_lights_[area_entry(entry).light];
        return light.sphere ? &light : nullptr;
    }

    LightScene scene_;
    std::vector<AreaLight> area_lights_;
    std::vector<std::int32_t> light_of_shape_;
    std::vector<DeltaLight> delta_lights_;
    DiscreteTable delta_alone_;       ///< over delta lights
    DiscreteTable selection_;         ///< by power, over area lights, delta lights, parts of environments
    LightChoice choice_;              ///< of next event, over the same, but for area lights that are cut
    std::uint32_t area_entries_ = 0;  ///< patches of area lights: next event's first entries
    /// The light of each, and the first of each light; empty where none is cut.
    std::vector<std::uint32_t> light_of_entry_, first_entry_;
    Environments environments_;
    SceneBall ball_;
    bool shines_from_infinity_ = false;
    bool has_spheres_ = false;  ///< among area lights
};

}  // namespace treefarm
