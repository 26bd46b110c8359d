// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/scene/kinds/materials/principled_thin.h"
#include "worker/shading/principled.h"

namespace treefarm {

/// Mitsuba 3's principled BSDF of a thin sheet. Transmission by its facets is their reflection, mirrored to the other
/// side. Lobe probabilities are Mitsuba's.
struct PrincipledThinBsdf {
    const PrincipledInputs* in = nullptr;  ///< lives as long as the materials, or as the hit
    float diff_trans = 0;                  ///< fraction of the diffuse light that passes, in [0, 1]
    Microfacet through;                    ///< facets of transmission

    LobeBits lobes() const {
        const int bits = kWideLobe | kSmoothLobe | kViewLobe;
        return static_cast<LobeBits>(transmits() ? bits | kTransmittingLobe : bits);
    }
    float refraction() const { return 1.0f; }

    /// Value and density; out of line, as those of dielectrics.
    [[gnu::noinline]] BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        if (wi.z > 0.0f) return reflected_value(wo, wi);
        return wi.z < 0.0f && transmits() ? transmitted_value(wo, wi) : BsdfValue{};
    }

    [[gnu::noinline]] BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const float facets = 0.5f * in->spec_trans, diffuse = 1.0f - in->spec_trans;
        Vec3 wi;
        bool passes = false;
        if (random.lobe < in->spec_trans) {
            passes = random.lobe >= facets;
            const Vec3 m = (passes ? through : in->facets).sample_visible(wo, random.point);
            wi = reflected(wo, m);
            if (!(wi.z > 0.0f) || (passes && !seen_from_behind(wi, m))) return {};
        } else {
            passes = random.lobe >= in->spec_trans + diffuse * (1.0f - diff_trans);
            wi = random.cosine;
        }
        if (passes) wi.z = -wi.z;
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }

  private:
    bool transmits() const { return in->spec_trans > 0.0f || diff_trans > 0.0f; }

    BsdfValue reflected_value(const Vec3& wo, const Vec3& wi) const {
        const float diffuse = (1.0f - in->spec_trans) * (1.0f - diff_trans);
        const RoughReflection r = rough_reflection(in->facets, wo, wi);
        BsdfValue result{in->base_value(wo, wi, r.cos_o, diffuse, diffuse) * wi.z,
                         diffuse * cosine_hemisphere_pdf(wi.z)};
        if (in->spec_trans > 0.0f) {
            const DielectricFresnel exact = fresnel_dielectric(r.cos_o, in->eta);
            const float tint = in->spec_tint;
            const Rgb colour = Rgb((1.0f - tint) * exact.reflectance) + in->tinted_reflectance(r.cos_o, exact) * tint;
            result.f_cos += colour * (in->spec_trans * r.f_cos);
            result.pdf += 0.5f * in->spec_trans * r.pdf;
        }
        return result;
    }

    /// Whether a facet of normal h sees the transmitted direction from behind; `turned`: that direction's mirror image.
    /// Mitsuba drops the directions that h sees on its front.
    static bool seen_from_behind(const Vec3& turned, const Vec3& h) {
        return turned.x * h.x + turned.y * h.y < turned.z * h.z;
    }

    BsdfValue transmitted_value(const Vec3& wo, const Vec3& wi) const {
        const float diffuse = (1.0f - in->spec_trans) * diff_trans, cos = -wi.z;
        BsdfValue result{in->base * (diffuse * kInvPi * cos), diffuse * cosine_hemisphere_pdf(cos)};
        const Vec3 turned(wi.x, wi.y, cos), h = wo + turned;
        if (!(in->spec_trans > 0.0f) || !seen_from_behind(turned, h)) return result;
        const RoughReflection r = rough_reflection(through, wo, turned);
        const float passes = 1.0f - fresnel_dielectric(r.cos_o, in->eta).reflectance;
        result.f_cos += in->base * (in->spec_trans * passes * r.f_cos);
        result.pdf += 0.5f * in->spec_trans * r.pdf;
        return result;
    }
};

template <>
struct BsdfNeeds<PrincipledThinMaterial> : NoBsdfNeeds {
    using Kept = PrincipledInputs;
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const PrincipledThinMaterial& m, const Context& at) {
    PrincipledInputs in;
    in.base = at.color(m.base_color);
    in.roughness = at.fraction(m.roughness);
    in.spec_trans = at.fraction(m.spec_trans);
    in.spec_tint = at.fraction(m.spec_tint);
    in.sheen = at.fraction(m.sheen);
    in.sheen_tint = at.fraction(m.sheen_tint);
    in.flatness = at.fraction(m.flatness);
    in.eta = at.number(m.eta);
    const float anisotropic = at.fraction(m.anisotropic);
    in.facets = PrincipledInputs::facets_of(in.roughness, anisotropic);
    // Burley 2015, figure 15.
    const Microfacet through = PrincipledInputs::facets_of((0.65f * in.eta - 0.35f) * in.roughness, anisotropic);
    const float passing = at.number(m.diff_trans) / PrincipledThinMaterial::kMostDiffTrans;
    return {PrincipledThinBsdf{at.keep(in), std::clamp(passing, 0.0f, 1.0f), through}};
}

}  // namespace treefarm
