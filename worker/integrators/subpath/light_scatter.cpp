// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/subpath/light_scatter.h"

#include <algorithm>
#include <type_traits>

namespace treefarm {
namespace {

/// Part of a blend that sample() chose, and the rest of its random number.
struct BlendChoice {
    const Bsdf* part;
    float rest;
};

/// Choice of BlendBsdf::sample() for the random number `lobe`.
BlendChoice choose(const BlendBsdf& blend, float lobe) {
    const float first = 1.0f - blend.weight;
    const bool takes_second = !(lobe < first);
    const float rest = takes_second ? (lobe - first) / blend.weight : lobe / first;
    return {takes_second ? blend.second : blend.first, std::min(rest, 0x1.fffffep-1f)};
}

}  // namespace

float delta_role(const Bsdf& bsdf, const Vec3& wo, const Vec3& wi, const BsdfRandom& random) {
    return bsdf.visit([&]<class Kind>(const Kind& kind) -> float {
        if constexpr (std::is_same_v<Kind, BlendBsdf>) {
            const BlendChoice choice = choose(kind, random.lobe);
            return delta_role(*choice.part, wo, wi, {choice.rest, random.point, random.cosine});
        } else if constexpr (std::is_same_v<Kind, OrientedBsdf>) {
            const float inner = delta_role(*kind.inner, kind.to_inner(wo), kind.to_inner(wi), random);
            return kind.shadow_alpha2 > 0.0f ? inner * kind.shadowing(wo) / kind.shadowing(wi) : inner;
        } else {
            const float eta = wi.z < 0.0f ? refraction_of(bsdf) : 1.0f;
            return eta * eta * std::abs(wo.z / wi.z);
        }
    });
}

}  // namespace treefarm
