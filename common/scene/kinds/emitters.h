// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <type_traits>
#include <variant>

#include "common/scene/kinds/emitters/area.h"
#include "common/scene/kinds/emitters/constant.h"
#include "common/scene/kinds/emitters/directional.h"
#include "common/scene/kinds/emitters/environment.h"
#include "common/scene/kinds/emitters/point.h"
#include "common/scene/kinds/emitters/projector.h"
#include "common/scene/kinds/emitters/spot.h"
#include "common/scene/kinds/fields.h"

namespace treefarm {

/// Every kind of emitter. Its place here is its number in packed form: new ones come last.
using EmitterKind = std::variant<AreaEmitter, PointEmitter, SpotEmitter, DirectionalEmitter, ConstantEmitter,
                                 EnvironmentEmitter, ProjectorEmitter>;

/// What a kind of emitter must say of itself: its values, what it is, about how bright the scene is in its light, and a
/// delta light where it shines.
template <class Kind>
concept SaysWhatItIs = requires(Kind& kind, const Kind& constant, IgnoreFields& visitor, const LitScene& scene) {
    Kind::fields(kind, visitor);
    { Kind::kTraits } -> std::same_as<const EmitterTraits&>;
    { constant.radiance_scale(scene) } -> std::same_as<float>;
}
&&(Kind::kTraits.type != LightType::delta || requires(const Kind& kind) {
    { kind.cone() } -> std::same_as<std::optional<LightCone>>;
});

/// Calls f.operator()<Kind>() for every kind of emitter.
template <class F>
void for_each_emitter_kind(F&& f) {
    const auto call = [&]<class... Kinds>(std::type_identity<std::variant<Kinds...>>) {
        static_assert((SaysWhatItIs<Kinds> && ...));
        static_assert(((Kinds::kTraits.effect && Kinds::kTraits.title) && ...));
        (f.template operator()<Kinds>(), ...);
    };
    call(std::type_identity<EmitterKind>());
}

}  // namespace treefarm
