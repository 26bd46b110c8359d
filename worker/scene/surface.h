// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/frame.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Surface at a path's vertex, as far as the walk needs it. One of two classes, a template argument of the path kernel,
/// so that plainly diffuse scenes pay for no other material.

/// A surface of a plainly diffuse scene (is_plainly_diffuse()): no delta lobes, no transmission, no textures.
class DiffuseSurface {
  public:
    using Bsdf = PlainDiffuse;
    static constexpr bool kGeneral = false, kTransmits = false;
    struct Scratch {};
    static Scratch make_scratch(const TraceScene&) { return {}; }
    static void prefetch(const TraceScene&, const Hit&) {}

    /// `outgoing`: unit, in world space, in the direction that light goes to.
    DiffuseSurface(const TraceScene& scene, const Hit& hit, const Vec3& outgoing, Scratch&)
        : bsdf_(scene.plain_diffuse(hit.shape)), hit_(hit), frame_(hit.ns), wo_(frame_.to_local(outgoing)) {}

    bool black() const { return !bsdf_.reflects(wo_); }
    const Bsdf& bsdf() const { return bsdf_; }
    const Frame& frame() const { return frame_; }
    const Vec3& wo() const { return wo_; }
    const Vec3& ng() const { return hit_.ng; }
    /// Shading normal on wo's side.
    Vec3 front() const { return wo_.z < 0.0f ? -frame_.n : frame_.n; }
    Vec3 bent_normal() const { return front(); }
    static constexpr bool smooth() { return true; }
    static constexpr bool evaluate_late() { return false; }
    static constexpr bool transmits() { return false; }
    static constexpr bool has_delta() { return false; }
    static constexpr bool delta_or_transmitting() { return false; }

  private:
    const Bsdf& bsdf_;
    const Hit& hit_;
    Frame frame_;
    Vec3 wo_;
};

/// A surface of any material. Its frame has `wo` on the side of +z; textures, bumps and tangents are looked up only for
/// materials that have them.
class GeneralSurface {
  public:
    using Bsdf = treefarm::Bsdf;
    static constexpr bool kGeneral = true, kTransmits = true;
    using Scratch = BsdfScratch;
    static Scratch make_scratch(const TraceScene& scene) { return scene.materials().make_scratch(); }

    /// `flat`: without bump and normal maps.
    GeneralSurface(const TraceScene& scene, const Hit& hit, const Vec3& outgoing, Scratch& scratch, bool flat = false)
        : frame_(hit.ns), wo_(frame_.to_local(outgoing)), ng_(hit.ng) {
        const bool back = wo_.z < 0.0f;
        if (back) {
            frame_.n = -frame_.n;
            wo_.z = -wo_.z;
            ng_ = -ng_;
        }
        const MaterialSet::Side& side = scene.materials().side(hit.shape, back);
        bsdf_ = side.bsdf;
        lobes_ = side.lobes;
        if (!bsdf_ && side.material != kNone) look_up(scene, hit, side.material, back, flat, scratch);
    }

    /// Prefetches the data that a hit's material will look up.
    static void prefetch(const TraceScene& scene, const Hit& hit) {
        const std::int32_t material = scene.materials().side(hit.shape, false).material;
        if (material != kNone) prefetch(scene, hit, material);
    }

    bool black() const { return !bsdf_ || !(wo_.z > 0.0f); }
    const Bsdf& bsdf() const { return *bsdf_; }
    const Frame& frame() const { return frame_; }
    const Vec3& wo() const { return wo_; }
    /// Geometric normal on wo's side of the shading normal's plane.
    const Vec3& ng() const { return ng_; }
    /// Whether any lobe has a density, as next event and guides require.
    bool smooth() const { return lobes_ & kSmoothLobe; }
    /// Whether next event gains by evaluating the BSDF only for visible emitters. False if a black value often saves
    /// the shadow ray, or if the value is cheap.
    bool evaluate_late() const { return lobes_ & kWideLobe; }
    /// Shading normal on wo's side.
    const Vec3& front() const { return frame_.n; }
    /// Normal that the BSDF scatters about, with bump and normal maps, on wo's side.
    Vec3 bent_normal() const { return black() ? front() : frame_.to_world(shading_normal_of(*bsdf_)); }
    bool transmits() const { return lobes_ & kTransmittingLobe; }
    /// Whether the sampled directions depend on wo.
    bool view_dependent() const { return lobes_ & kViewLobe; }
    bool has_delta() const { return lobes_ & kDeltaLobe; }
    bool delta_or_transmitting() const { return lobes_ & (kDeltaLobe | kTransmittingLobe); }

    /// Squared relative index of refraction: the factor by which refraction to the far side reduces a path's
    /// throughput.
    float eta2() const {
        const float eta = refraction_of(*bsdf_);
        return eta * eta;
    }

  private:
    static void prefetch(const TraceScene& scene, const Hit& hit, std::int32_t material);
    void look_up(const TraceScene& scene, const Hit& hit, std::int32_t material, bool back, bool flat,
                 Scratch& scratch);

    const Bsdf* bsdf_;
    Frame frame_;
    Vec3 wo_, ng_;
    LobeBits lobes_;
};

}  // namespace treefarm
