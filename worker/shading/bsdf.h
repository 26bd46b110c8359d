// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>
#include <variant>

#include "common/base/switch_visit.h"
#include "worker/shading/blend.h"
#include "worker/shading/coating.h"
#include "worker/shading/conductor.h"
#include "worker/shading/dielectric.h"
#include "worker/shading/diffuse.h"
#include "worker/shading/diffuse_transmitter.h"
#include "worker/shading/null.h"
#include "worker/shading/oriented.h"
#include "worker/shading/phong.h"
#include "worker/shading/plastic.h"
#include "worker/shading/principled.h"
#include "worker/shading/principled_thin.h"
#include "worker/shading/rough_conductor.h"
#include "worker/shading/rough_dielectric.h"
#include "worker/shading/rough_diffuse.h"
#include "worker/shading/rough_plastic.h"
#include "worker/shading/thin_dielectric.h"
#include "worker/shading/thin_layer.h"
#include "worker/shading/ward.h"

namespace treefarm {

/// BSDF of a black surface.
struct BlackBsdf {
    static constexpr LobeBits kLobes = 0;

    BsdfValue value(const Vec3&, const Vec3&) const { return {}; }
    BsdfSample sample(const Vec3&, const BsdfRandom&) const { return {}; }
};

/// Every BSDF; a new one is added at the end. It states its lobes (kLobes or lobes()) and, if it transmits, its
/// refraction(), or it does not compile.
using BsdfKind = std::variant<BlackBsdf, DiffuseBsdf, RoughConductorBsdf, RoughDielectricBsdf, RoughPlasticBsdf,
                              PlasticBsdf, ConductorBsdf, DielectricBsdf, ThinDielectricBsdf, NullBsdf, BlendBsdf,
                              OrientedBsdf, RoughDiffuseBsdf, PhongBsdf, WardBsdf, PrincipledBsdf, CoatingBsdf,
                              RoughCoatingBsdf, PrincipledThinBsdf, DiffuseTransmitterBsdf, ThinLayerBsdf>;

template <class Kind>
constexpr bool may_transmit() {
    if constexpr (requires { Kind::kLobes; })
        return (Kind::kLobes & kTransmittingLobe) != 0;
    else
        return false;
}

/// Whether a kind is smooth glass: one reflected and one refracted direction, and nothing else.
template <class Kind>
constexpr bool has_two_branches() {
    if constexpr (requires { Kind::kLobes; })
        return Kind::kLobes == (kDeltaLobe | kTransmittingLobe);
    else
        return false;
}

// Stored at every vertex of a scene with textures: larger inputs are kept apart (BsdfNeeds::Kept).
static_assert(sizeof(BsdfKind) <= 64, "a BSDF became larger: keep its inputs aside (bsdf_needs.h)");

/// BSDF of one side of a surface at one point: a closed set, no virtual call, no allocation.
struct Bsdf {
    BsdfKind kind;

    /// Calls f with the held alternative, by a switch; std::visit would call through a table.
    template <class F>
    auto visit(F&& f) const {
        return switch_visit(kind, [&](const auto& bsdf) { return f(bsdf); });
    }

    /// f |cos(wi)| and density for wo.z > 0, without delta lobes.
    BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        return visit([&](const auto& bsdf) { return bsdf.value(wo, wi); });
    }
    /// Samples wi for wo.z > 0.
    BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        return visit([&](const auto& bsdf) { return bsdf.sample(wo, random); });
    }

    /// The other branch of smooth glass, on the opposite side of `taken`; density 0 for other BSDFs, or if there is
    /// none.
    BsdfSample other_branch(const Vec3& wo, const Vec3& taken) const {
        if (!visit([](const auto& bsdf) { return has_two_branches<std::decay_t<decltype(bsdf)>>(); })) return {};
        const float last_lobe = taken.z > 0.0f ? 0x1.fffffep-1f : 0.0f;
        const BsdfSample other = sample(wo, {last_lobe, Vec2(0.5f)});
        return (other.wi.z > 0.0f) != (taken.z > 0.0f) ? other : BsdfSample{};
    }
};

/// Lobes of a BSDF.
LobeBits lobes_of(const Bsdf& bsdf);

/// Relative index of refraction of the far side, 1 without refraction; roulette undoes the scaling of radiance by it.
/// For a blend, that of the first part that refracts.
float refraction_of(const Bsdf& bsdf);

/// Unit normal that a BSDF scatters about, in the frame of its surface: (0, 0, 1) unless a bump or normal map tilts it.
/// Of a blend the mean of its parts' normals; of a coat that of the BSDF beneath it.
Vec3 shading_normal_of(const Bsdf& bsdf);

inline BsdfValue BlendBsdf::value(const Vec3& wo, const Vec3& wi) const {
    const BsdfValue a = first->value(wo, wi), b = second->value(wo, wi);
    return {a.f_cos * (1.0f - weight) + b.f_cos * weight, a.pdf * (1.0f - weight) + b.pdf * weight};
}

inline BsdfSample BlendBsdf::sample(const Vec3& wo, const BsdfRandom& random) const {
    const bool takes_second = !(random.lobe < 1.0f - weight);
    const float probability = takes_second ? weight : 1.0f - weight;
    // The rest of the number chooses among the part's lobes; rounding may bring it to 1.
    const float rest =
        std::min((takes_second ? random.lobe - (1.0f - weight) : random.lobe) / probability, 0x1.fffffep-1f);
    BsdfSample s = (takes_second ? second : first)->sample(wo, {rest, random.point});
    if (!(s.pdf > 0.0f)) return s;
    if (s.delta) {
        s.pdf *= probability;
        s.f_cos *= probability;
    } else {
        const BsdfValue v = value(wo, s.wi);
        s.pdf = v.pdf;
        s.f_cos = v.f_cos;
    }
    return s;
}

inline BsdfValue LayeredBsdf::value(const Vec3& wo, const Vec3& wi) const {
    const Vec3 out = refracted(wo, eta), in = refracted(wi, eta);
    if (out.z == 0.0f || in.z == 0.0f) return {};
    BsdfValue value = beneath->value(out, in);
    const float shrunk = std::abs(wi.z) / (std::abs(in.z) * eta * eta);
    value.f_cos *= absorbed(out, in) * shrunk;
    value.pdf *= shrunk;
    return value;
}

inline BsdfSample LayeredBsdf::sample(const Vec3& wo, const BsdfRandom& random) const {
    const Vec3 out = refracted(wo, eta);
    if (out.z == 0.0f) return {};
    BsdfSample sample = beneath->sample(out, random);
    if (!(sample.pdf > 0.0f)) return {};
    const Vec3 in = sample.wi;
    sample.wi = refracted(in, 1.0f / eta);
    if (sample.wi.z == 0.0f) return {};
    if (sample.delta) sample.f_cos *= absorbed(out, in);
    return sample;
}

inline BsdfValue OrientedBsdf::value(const Vec3& wo, const Vec3& wi) const {
    const Vec3 inside = to_inner(wi);
    if (!(inside.z * wi.z > 0.0f)) return {};
    BsdfValue value = inner->value(to_inner(wo), inside);
    if (shadow_alpha2 > 0.0f) value.f_cos *= shadowing(wi);
    return value;
}

inline BsdfSample OrientedBsdf::sample(const Vec3& wo, const BsdfRandom& random) const {
    BsdfSample sample = inner->sample(to_inner(wo), random);
    if (!(sample.pdf > 0.0f)) return sample;
    const float inside = sample.wi.z;
    sample.wi = to_outer(sample.wi);
    if (!(inside * sample.wi.z > 0.0f)) return {};
    if (shadow_alpha2 > 0.0f) sample.f_cos *= shadowing(sample.wi);
    return sample;
}

}  // namespace treefarm
