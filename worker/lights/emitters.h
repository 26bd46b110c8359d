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

/// All emitters of a scene: their emission, and its sampling by next event. Emitters are chosen by power, none less
/// often than a thousandth of its even probability, or by LightChoice; points on meshes, disks and cylinders uniformly
/// by area, spheres by the cone they subtend, a constant environment uniformly over the sphere of directions, an image
/// by its luminance. Immutable. `geometry` and `textures` must outlive it.
class Emitters {
  public:
    /// `bounds`: box of the scene, which sets the power of light from infinity. Throws RunError if an emitter needs
    /// textures that are missing.
    Emitters(const std::vector<Emitter>& emitters, const EmbreeScene& geometry, const Box3& bounds,
             const TextureSet* textures = nullptr, LightSelection how = LightSelection::power);

    /// Whether anything emits.
    bool can_sample() const { return !selection_.empty(); }

    /// Whether environment() may be other than black.
    bool shines_from_infinity() const { return shines_from_infinity_; }

    /// Samples a direction from p to an emitter. random[0] chooses the emitter, [1] the triangle, [2] and [3] the
    /// point; for an environment map [1] and [2] the texel, [3] the offset from it. Samples from infinity have no
    /// radiance yet: environment() returns it once they are known to be visible. `probabilities`: learned choice of
    /// emitters at p; nullptr: none. `front`: normal of a surface at p that only reflects; emitters behind it may be
    /// chosen less often or never, and a sample behind it, or of an emitter that faces away from p, may be dropped
    /// early. nullptr: every sample has its density.
    DirectSample sample_direct(const Vec3& p, const Draw& random, const LightProbabilities* probabilities = nullptr,
                               const Vec3* front = nullptr) const {
        return sample_direct(LightReceiver(p, probabilities, front), random);
    }
    DirectSample sample_direct(const LightReceiver& receiver, const Draw& random) const;

    /// Whether drawing many samples together is faster.
    bool draws_together() const { return has_spheres_ || has_map() || choice_.flat(); }
    // Sampling of many together: clear the batch, choose() for all lanes that may sample, draw(), and sample_direct()
    // for those that do, each with the numbers of its choice. The density of an environment map's sample is set later,
    // as its radiance is: until then it is 1.
    void choose(LightBatch& batch, std::uint32_t lane, const LightReceiver& receiver, const Draw& random) const;
    void draw(LightBatch& batch) const;
    DirectSample sample_direct(const LightBatch& batch, std::uint32_t lane, const Draw& random) const;
    /// Keeps the estimates that a lane's choice has computed, so that later densities at `receiver` need not compute
    /// them again; in `storage`, which must last as long as `receiver`.
    void keep(const LightBatch& batch, std::uint32_t lane, LightReceiver& receiver, LightWidthStore& storage) const {
        const FlatLights* const few = choice_.flat();
        if (!few) return;
        batch.flat.copy_widths(lane, storage.data(), few->count());
        receiver.widths = storage.data();
    }
    /// Whether samples may be of an environment map.
    bool has_map() const { return environments_.map().shines(); }
    /// Radiance from infinity, opposite to the direction of a lane's sample.
    Rgb environment(const LightBatch& batch, std::uint32_t lane, const Vec3& direction) const;
    /// Density of a lane's sample, for which sample_direct() returned `pdf`.
    float environment_pdf(const LightBatch& batch, std::uint32_t lane, float pdf) const;
    /// Prefetches the data of environment() and environment_pdf().
    void prefetch_environment(const LightBatch& batch, std::uint32_t lane) const;
    /// Next event's choice of emitters.
    const LightChoice& choice() const { return choice_; }

    /// Whether there are lights without extent, which only emitter sampling finds.
    bool has_delta_lights() const { return !delta_lights_.empty(); }
    /// Sample as of sample_direct(), of the lights without extent alone.
    DirectSample sample_delta(const Vec3& p, const Draw& random) const;

    /// Density per steradian with which sample_direct(p) finds `hit` along the unit direction wi; 0 if it never does.
    /// `probabilities` and `front` must equal those of the sample, or the MIS weights do not sum to one.
    float pdf_direct(const Vec3& p, const Vec3& wi, const Hit& hit, const LightProbabilities* probabilities = nullptr,
                     const Vec3* front = nullptr) const {
        return pdf_direct(LightReceiver(p, probabilities, front), wi, hit);
    }
    float pdf_direct(const LightReceiver& receiver, const Vec3& wi, const Hit& hit) const;

    /// Choice of light paths' emitters with this emphasis of a pass (emission_shares.h); empty: by power. Throws
    /// RunError if its size does not fit.
    EmissionChoice emission_choice(std::span<const float> emphasis = {}) const {
        return EmissionChoice(selection_, emphasis);
    }
    // In what follows `choice` is nullptr for the choice by power; all densities of one path need the same.
    /// Ray that leaves an emitter, the beginning of a light path; chosen independently of next event. `place` chooses
    /// the start, as the numbers of sample_direct() do, or the direction of light from infinity; direction[0] and [1]
    /// choose the direction, or the position across it. A scene without surfaces has no rays.
    EmissionSample emit(const Draw& position, const Draw& direction, const EmissionChoice* choice = nullptr) const;
    /// Densities with which emit() starts at a point of an area emitter in the unit direction `away`; zeros if it does
    /// not shine there.
    EmissionDensity emission_density(const Hit& start, const Vec3& away, const EmissionChoice* choice = nullptr) const;
    /// Densities of light from infinity that arrives against the unit `direction`.
    EmissionDensity emission_density(const Vec3& direction, const EmissionChoice* choice = nullptr) const;
    /// Densities with which emit() starts at next event's sample, which was drawn at `receiver` by these numbers;
    /// `delta_alone`: by sample_delta().
    EmissionDensity emission_density(const DirectSample& sample, const LightReceiver& receiver, const Draw& random,
                                     bool delta_alone, const EmissionChoice* choice = nullptr) const;
    /// Density with which sample_direct() at `receiver` finds the start of a light path, in the measure of its
    /// position_pdf.
    double next_event_pdf(const EmissionSample& start, const LightReceiver& receiver) const;

    /// Whether emitted() may be other than black on a shape.
    bool emits(std::uint32_t shape) const { return light_of_shape_[shape] != kNone; }

    /// Radiance that leaves a surface point in the direction `wo`.
    Rgb emitted(const Hit& hit, const Vec3& wo) const {
        const std::int32_t light = light_of_shape_[hit.shape];
        if (light == kNone || !(dot(hit.ng, wo) > 0.0f)) return Rgb(0.0f);
        const AreaLight& area = area_lights_[static_cast<std::size_t>(light)];
        if (area.texture != kNone) [[unlikely]]
            return area.textured(scene_, hit).rgb();
        return area.radiance;
    }

    /// Radiance from infinity, arriving against the unit `direction`.
    Rgb environment(const Vec3& direction) const { return environments_.radiance(direction); }

    /// Density of sample_direct(p) for a direction in which nothing is hit; arguments as for pdf_direct().
    float pdf_environment(const Vec3& p, const Vec3& direction, const LightProbabilities* probabilities = nullptr,
                          const Vec3* front = nullptr) const {
        return pdf_environment(LightReceiver(p, probabilities, front), direction);
    }
    float pdf_environment(const LightReceiver& receiver, const Vec3& direction) const {
        return environments_.pdf(direction, probabilities_at(receiver));
    }

  private:
    /// Adds an area light and returns its power.
    double add_area_light(const AreaEmitter& emitter);
    void select(std::vector<double> power, LightSelection how);
    /// Sets up next event's choice by position, among patches of area lights and all other emitters, with these powers.
    void select_by_point(std::span<const double> power, LightSelection how);

    /// A patch of an area light.
    struct AreaEntry {
        std::uint32_t light, patch;
    };
    /// Whether next event's entry is a patch of an area light.
    bool is_area(std::uint32_t entry) const { return entry < area_entries_; }
    AreaEntry area_entry(std::uint32_t entry) const {
        if (light_of_entry_.empty()) return {entry, 0};
        const std::uint32_t light = light_of_entry_[entry];
        return {light, entry - first_entry_[light]};
    }
    /// Next event's entry of a hit.
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
    /// Sample of an emitter other than a plain mesh; out of line, so that plain meshes pay nothing for the other kinds.
    [[gnu::noinline]] DirectSample sample_other(const LightPick& chosen, const LightReceiver& receiver,
                                                const Draw& random) const;
    DirectSample sample_without_area(const LightPick& chosen, const LightReceiver& receiver, const Draw& random) const;
    EntryProbabilities probabilities_at(const LightReceiver& receiver, const LightPick& known = {}) const {
        if (choice_.by_power()) return {};
        return {&choice_, &receiver, known};
    }
    DirectSample sample(const LightPick& chosen, const LightReceiver& receiver, const Draw& random) const;
    /// Adds a lane's chosen emitter to the batch of its kind, if it has one.
    void file(LightBatch& batch, std::uint32_t lane) const;
    /// Whether next event's entry is a part of the environment map.
    bool is_map(std::uint32_t entry) const { return environments_.is_map(entry); }
    /// Light of next event's entry, if it is an emitting sphere; otherwise nullptr.
    const AreaLight* sphere_light(std::uint32_t entry) const {
        if (!is_area(entry)) return nullptr;
        const AreaLight& light = area_lights_[area_entry(entry).light];
        return light.sphere ? &light : nullptr;
    }

    LightScene scene_;
    std::vector<AreaLight> area_lights_;
    std::vector<std::int32_t> light_of_shape_;
    std::vector<DeltaLight> delta_lights_;
    DiscreteTable delta_alone_;  ///< over delta lights
    DiscreteTable selection_;    ///< by power, over area lights, delta lights, parts of environments
    /// of next event, over the same entries, with area lights replaced by their patches
    LightChoice choice_;
    std::uint32_t area_entries_ = 0;  ///< number of area patches: next event's first entries
    /// Light of each patch, and first patch of each light; empty if no light is cut.
    std::vector<std::uint32_t> light_of_entry_, first_entry_;
    Environments environments_;
    SceneBall ball_;
    bool shines_from_infinity_ = false;
    bool has_spheres_ = false;  ///< among area lights
};

}  // namespace treefarm
