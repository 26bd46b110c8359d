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

/// All kinds of emitters. The index of a kind is its number in packed form: new kinds come last.
using EmitterKind = std::variant<AreaEmitter, PointEmitter, SpotEmitter, DirectionalEmitter, ConstantEmitter,
                                 EnvironmentEmitter, ProjectorEmitter>;

/// Requirements of a kind of emitter: fields, traits, estimated brightness of the scene in its light, and for a delta
/// light the cone of its light.
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
