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

/// Every light without extent. A class states the kind of emitter that its constructor takes with the textures
/// (nullptr: none); power(scene_radius); bounds(); sample(p, selection), its light at a point; emit(ball, random), a
/// ray that leaves it; and direction_pdf(ball, away), that ray's density.
using DeltaLightKind = std::variant<PointLight, SpotLight, DirectionalLight, ProjectorLight>;

/// An emitter without extent: a closed set, no virtual call. Scattering never finds it; next event always does.
class DeltaLight {
  public:
    /// Light of an emitter without extent; no value for others. `textures` must outlive it. Throws RunError if it needs
    /// textures and there are none.
    static std::optional<DeltaLight> make(const Emitter& emitter, const TextureSet* textures);

    /// Power sent into a scene of this radius, in watts, mean of the channels; for some kinds an estimate.
    double power(double scene_radius) const;

    /// Approximate bounds of its light.
    LightBounds bounds() const;

    /// Light that reaches p; pdf is `selection`.
    DirectSample sample(const Vec3& p, float selection) const;

    /// Ray that leaves the light, as if it were the only one. random[0] and [1] choose the direction, or the position
    /// across parallel light.
    EmissionSample emit(const SceneBall& ball, const Draw& random) const;
    /// EmissionSample::direction_pdf of a ray in the unit direction `away`, into which the light shines.
    float direction_pdf(const SceneBall& ball, const Vec3& away) const;

  private:
    explicit DeltaLight(DeltaLightKind kind) : kind_(std::move(kind)) {}

    DeltaLightKind kind_;
};

}  // namespace treefarm
