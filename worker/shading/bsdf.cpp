#include "worker/shading/bsdf.h"

#include <type_traits>

namespace treefarm {

LobeBits lobes_of(const Bsdf& bsdf) {
    return bsdf.visit([](const auto& b) -> LobeBits {
        using Kind = std::decay_t<decltype(b)>;
        if constexpr (std::is_same_v<Kind, BlackBsdf>)
            return 0;
        else if constexpr (std::is_same_v<Kind, BlendBsdf>)
            return static_cast<LobeBits>(lobes_of(*b.first) | lobes_of(*b.second));
        else if constexpr (std::is_same_v<Kind, OrientedBsdf>)
            return lobes_of(*b.inner);
        else if constexpr (std::is_same_v<Kind, RoughDielectricBsdf>)
            return kSmoothLobe | kTransmittingLobe | kViewLobe;
        else if constexpr (std::is_same_v<Kind, DielectricBsdf> || std::is_same_v<Kind, ThinDielectricBsdf>)
            return kDeltaLobe | kTransmittingLobe;
        else if constexpr (std::is_same_v<Kind, PlasticBsdf>)
            return kSmoothLobe | kWideLobe | kDeltaLobe;
        else if constexpr (std::is_same_v<Kind, DiffuseBsdf>)
            return kSmoothLobe | kWideLobe;
        else if constexpr (std::is_same_v<Kind, RoughPlasticBsdf>)
            return kSmoothLobe | kWideLobe | kViewLobe;
        else if constexpr (requires { b.facets; })
            return kSmoothLobe | kViewLobe;
        else
            return kDeltaLobe;
    });
}

float refraction_of(const Bsdf& bsdf) {
    return bsdf.visit([](const auto& b) -> float {
        using Kind = std::decay_t<decltype(b)>;
        if constexpr (std::is_same_v<Kind, DielectricBsdf> || std::is_same_v<Kind, RoughDielectricBsdf>)
            return b.eta;
        else if constexpr (std::is_same_v<Kind, OrientedBsdf>)
            return refraction_of(*b.inner);
        else if constexpr (std::is_same_v<Kind, BlendBsdf>) {
            const float first = refraction_of(*b.first);
            return first != 1.0f ? first : refraction_of(*b.second);
        } else
            return 1.0f;
    });
}

}  // namespace treefarm
