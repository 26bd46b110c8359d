// SPDX-License-Identifier: Apache-2.0
#include "worker/lights/delta_light.h"

#include <type_traits>

#include "common/base/switch_visit.h"

namespace treefarm {
namespace {

/// Light class of a kind of emitter. Each kind of delta light has exactly one.
template <class Kind, class First, class... Others>
auto light_from(const Kind& kind, const TextureSet* textures) {
    if constexpr (std::is_same_v<typename First::Kind, Kind>) {
        return First(kind, textures);
    } else {
        static_assert(sizeof...(Others) > 0, "no light in DeltaLightKind is made from this kind of emitter");
        return light_from<Kind, Others...>(kind, textures);
    }
}

template <class Kind, class... Lights>
DeltaLightKind make_light(const Kind& kind, const TextureSet* textures, std::type_identity<std::variant<Lights...>>) {
    return light_from<Kind, Lights...>(kind, textures);
}

}  // namespace

std::optional<DeltaLight> DeltaLight::make(const Emitter& emitter, const TextureSet* textures) {
    return std::visit(
        [&]<class Kind>(const Kind& kind) -> std::optional<DeltaLight> {
            if constexpr (Kind::kTraits.type == LightType::delta)
                return DeltaLight(make_light(kind, textures, std::type_identity<DeltaLightKind>()));
            else
                return std::nullopt;
        },
        emitter.kind);
}

double DeltaLight::power(double scene_radius) const {
    return switch_visit(kind_, [&](const auto& light) { return light.power(scene_radius); });
}

LightBounds DeltaLight::bounds() const {
    return switch_visit(kind_, [](const auto& light) { return light.bounds(); });
}

EmissionSample DeltaLight::emit(const SceneBall& ball, const Draw& random) const {
    return switch_visit(kind_, [&](const auto& light) { return light.emit(ball, random); });
}

float DeltaLight::direction_pdf(const SceneBall& ball, const Vec3& away) const {
    return switch_visit(kind_, [&](const auto& light) { return light.direction_pdf(ball, away); });
}

DirectSample DeltaLight::sample(const Vec3& p, float selection) const {
    return switch_visit(kind_, [&](const auto& light) { return light.sample(p, selection); });
}

}  // namespace treefarm
