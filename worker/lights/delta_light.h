// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include "common/scene/model/emitter.h"
#include "worker/lights/direct_sample.h"
#include "worker/lights/directional.h"
#include "worker/lights/emission_sample.h"
#include "worker/lights/point.h"
#include "worker/lights/projector.h"
#include "worker/lights/spot.h"

namespace treefarm {

/// Every light without extent. Each names the kind of emitter that it is made from, which its constructor takes with
/// the textures (nullptr: there are none), and says its power(scene_radius), its bounds(), what reaches a place:
/// sample(p, selection), what leaves it: emit(ball, random), and how densely along a ray: direction_pdf(ball, away).
using DeltaLightKind = std::variant<PointLight, SpotLight, DirectionalLight, ProjectorLight>;

/// An emitter without extent: a closed set, no virtual call. Scattering never finds it; next event always does.
class DeltaLight {
  public:
    /// None for emitters with extent. `textures` must outlive it; RunError if it needs some and there are none.
    static std::optional<DeltaLight> make(const Emitter& emitter, const TextureSet* textures);

    /// Mean of the channels of the power that it sends into a scene of that radius, in watts; of some an estimate.
    double power(double scene_radius) const;

    /// What reaches places of it, about.
    LightBounds bounds() const;

    /// What reaches p; pdf is `selection`.
    DirectSample sample(const Vec3& p, float selection) const;

    /// A ray that leaves it, as if it were the only light. random[0] and [1] choose the direction, or the place across
    /// parallel light.
    EmissionSample emit(const SceneBall& ball, const Draw& random) const;
    /// EmissionSample::direction_pdf of a ray into the unit direction `away`, which it shines into.
    float direction_pdf(const SceneBall& ball, const Vec3& away) const;

  private:
    explicit DeltaLight(DeltaLightKind kind) : kind_(std::move(kind)) {}

    DeltaLightKind kind_;
};

}  // namespace treefarm
