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
