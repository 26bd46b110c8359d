// SPDX-License-Identifier: Apache-2.0
#include "worker/shading/bsdf.h"

namespace treefarm {

LobeBits lobes_of(const Bsdf& bsdf) {
    return bsdf.visit([](const auto& b) -> LobeBits {
        if constexpr (requires { b.lobes(); })
            return b.lobes();
        else
            return std::decay_t<decltype(b)>::kLobes;
    });
}

float refraction_of(const Bsdf& bsdf) {
    return bsdf.visit([](const auto& b) -> float {
        if constexpr (may_transmit<std::decay_t<decltype(b)>>() || requires { b.refraction(); })
            return b.refraction();
        else
            return 1.0f;
    });
}

Vec3 shading_normal_of(const Bsdf& bsdf) {
    return bsdf.visit([](const auto& b) -> Vec3 {
        if constexpr (requires { b.shading_normal(); })
            return b.shading_normal();
        else if constexpr (requires { b.layer; })
            return shading_normal_of(*b.layer.beneath);
        else
            return {0.0f, 0.0f, 1.0f};
    });
}

Vec3 BlendBsdf::shading_normal() const {
    const Vec3 a = shading_normal_of(*first), b = shading_normal_of(*second);
    return a == b ? a : normalize(a * (1.0f - weight) + b * weight);
}

Vec3 OrientedBsdf::shading_normal() const {
    return to_outer(shading_normal_of(*inner));
}

LobeBits BlendBsdf::lobes() const {
    return static_cast<LobeBits>(lobes_of(*first) | lobes_of(*second));
}

float BlendBsdf::refraction() const {
    const float of_first = refraction_of(*first);
    return of_first != 1.0f ? of_first : refraction_of(*second);
}

LobeBits LayeredBsdf::lobes() const {
    return lobes_of(*beneath);
}

float LayeredBsdf::refraction() const {
    return refraction_of(*beneath);
}

LobeBits OrientedBsdf::lobes() const {
    return lobes_of(*inner);
}

float OrientedBsdf::refraction() const {
    return refraction_of(*inner);
}

}  // namespace treefarm
