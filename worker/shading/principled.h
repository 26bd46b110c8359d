// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/warp.h"
#include "common/scene/kinds/materials/principled.h"
#include "worker/shading/bsdf_needs.h"
#include "worker/shading/clear_coat.h"
#include "worker/shading/rough_dielectric.h"

namespace treefarm {

/// Inputs of a principled BSDF at one point.
struct PrincipledInputs {
    Rgb base{0.5f};
    float roughness = 0.5f;
    float metallic = 0, spec_trans = 0, spec_tint = 0, sheen = 0, sheen_tint = 0, flatness = 0, clearcoat = 0;
    float eta = 1.5f;  ///< of the far side over that of wo's side
    Microfacet facets;
    ClearCoat coat;

    /// Weights of the diffuse and the refracting part.
    float diffuse() const { return (1.0f - metallic) * (1.0f - spec_trans); }
    float refracting() const { return (1.0f - metallic) * spec_trans; }
    /// Base color scaled to luminance 1.
    Rgb tint() const {
        const float light = luminance(base);
        return light > 0.0f ? base / light : Rgb(1.0f);
    }

    /// f of the base and of sheen, each with a weight; cos_h: cosine of both directions with their half vector.
    Rgb base_value(const Vec3& wo, const Vec3& wi, float cos_h, float base_weight, float sheen_weight) const {
        const float towards = schlick_weight(wi.z), away = schlick_weight(wo.z);
        const float retro = 2.0f * roughness * cos_h * cos_h;
        float shape =
            (1.0f - 0.5f * away) * (1.0f - 0.5f * towards) + retro * (towards + away + towards * away * (retro - 1.0f));
        if (flatness > 0.0f) {
            const float grazing = 0.5f * retro - 1.0f;
            const float flattened = (1.0f + grazing * towards) * (1.0f + grazing * away);
            const float below = 1.25f * (flattened * (1.0f / (wi.z + wo.z) - 0.5f) + 0.5f);
            shape += flatness * (below - shape);
        }
        Rgb f = base * (base_weight * kInvPi * shape);
        if (sheen > 0.0f) {
            const Rgb colour = Rgb(1.0f - sheen_tint) + tint() * sheen_tint;
            f += colour * (sheen * sheen_weight * schlick_weight(cos_h));
        }
        return f;
    }

    /// Reflectance of a dielectric tinted with the base color, by Schlick's approximation.
    Rgb tinted_reflectance(float cos_o, const DielectricFresnel& exact) const {
        const float at_normal = (eta - 1.0f) / (eta + 1.0f);
        return schlick(tint() * (at_normal * at_normal), cos_o, exact);
    }

    /// Schlick's approximation, by the angle on the side of the lower index.
    Rgb schlick(const Rgb& at_normal, float cos_o, const DielectricFresnel& exact) const {
        const float weight = schlick_weight(eta > 1.0f ? cos_o : exact.cos_transmitted);
        return at_normal * (1.0f - weight) + Rgb(weight);
    }

    static float schlick_weight(float cos) {
        const float m = std::clamp(1.0f - cos, 0.0f, 1.0f);
        return m * m * m * m * m;
    }

    /// Burley's facets: alpha is the squared roughness, stretched by anisotropy.
    static Microfacet facets_of(float roughness, float anisotropic) {
        const float aspect = std::sqrt(1.0f - 0.9f * anisotropic), alpha = roughness * roughness;
        constexpr float kLeast = 0.001f;
        return {true, std::max(kLeast, alpha / aspect), std::max(kLeast, alpha * aspect)};
    }
};

/// Mitsuba 3's principled BSDF; `inside`: seen from within, where it only reflects and refracts. Lobe probabilities are
/// Mitsuba's.
struct PrincipledBsdf {
    const PrincipledInputs* in = nullptr;  ///< lives as long as the materials, or as the hit
    bool inside = false;

    LobeBits lobes() const {
        const int bits = (inside ? 0 : kWideLobe) | kSmoothLobe | kViewLobe;
        return static_cast<LobeBits>(in->spec_trans > 0.0f ? bits | kTransmittingLobe : bits);
    }
    float refraction() const { return in->spec_trans > 0.0f ? in->eta : 1.0f; }

    /// Value and density; out of line, as those of dielectrics.
    [[gnu::noinline]] BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        if (wi.z > 0.0f) return reflected_value(wo, wi);
        if (!(wi.z < 0.0f) || !(in->spec_trans > 0.0f)) return {};
        const BsdfValue through = boundary().value(wo, wi);
        const float refracting = in->refracting();
        const Rgb colour(std::sqrt(in->base.x), std::sqrt(in->base.y), std::sqrt(in->base.z));
        return {through.f_cos * colour * refracting,
                inside ? through.pdf : probabilities().specular * refracting * through.pdf};
    }

    [[gnu::noinline]] BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const Probabilities p = probabilities();
        Vec3 wi;
        if (random.lobe < p.diffuse) {
            wi = random.cosine;
        } else if (random.lobe < p.diffuse + p.coat) {
            wi = reflected(wo, in->coat.sample(random.point));
            if (!(wi.z > 0.0f)) return {};
        } else {
            const Vec3 m = in->facets.sample_visible(wo, random.point);
            const float cos_o = dot(wo, m);
            if (!(cos_o > 0.0f)) return {};
            const DielectricFresnel f = fresnel_dielectric(std::min(1.0f, cos_o), in->eta);
            const float rest = (random.lobe - p.diffuse - p.coat) / p.specular;
            const bool reflects = rest < reflected_probability(f.reflectance);
            wi = reflects ? reflected(wo, m) : refract(wo, m, cos_o, f.cos_transmitted, in->eta);
            if (reflects != (wi.z > 0.0f)) return {};
        }
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }

  private:
    struct Probabilities {
        float diffuse, coat, specular;
    };

    Probabilities probabilities() const {
        if (inside) return {0.0f, 0.0f, 1.0f};
        const float diffuse = in->diffuse(), coat = 0.25f * in->clearcoat, all = 1.0f + diffuse + coat;
        return {diffuse / all, coat / all, 1.0f / all};
    }

    /// Probability of reflection among the specular lobe's samples, at a facet of this reflectance.
    float reflected_probability(float reflectance) const {
        return inside ? reflectance : 1.0f - in->refracting() * (1.0f - reflectance);
    }

    RoughDielectricBsdf boundary() const { return {in->eta, Rgb(1.0f), Rgb(1.0f), in->facets}; }

    Rgb specular_colour(float cos_o, const DielectricFresnel& exact) const {
        if (inside) return Rgb(in->refracting() * exact.reflectance);
        const float metallic = in->metallic, tint = in->spec_tint;
        return Rgb((1.0f - metallic) * (1.0f - tint) * exact.reflectance) +
               in->schlick(in->base, cos_o, exact) * metallic +
               in->tinted_reflectance(cos_o, exact) * ((1.0f - metallic) * tint);
    }

    BsdfValue reflected_value(const Vec3& wo, const Vec3& wi) const {
        const Probabilities p = probabilities();
        const RoughReflection r = rough_reflection(in->facets, wo, wi);
        const DielectricFresnel exact = fresnel_dielectric(r.cos_o, in->eta);
        BsdfValue result{specular_colour(r.cos_o, exact) * r.f_cos,
                         p.specular * reflected_probability(exact.reflectance) * r.pdf};
        if (inside) return result;
        result.f_cos += in->base_value(wo, wi, r.cos_o, in->diffuse(), 1.0f - in->metallic) * wi.z;
        result.pdf += p.diffuse * cosine_hemisphere_pdf(wi.z);
        if (in->clearcoat > 0.0f) add_coat(wo, wi, r.cos_o, p.coat, result);
        return result;
    }

    void add_coat(const Vec3& wo, const Vec3& wi, float cos_h, float probability, BsdfValue& result) const {
        const Vec3 h = normalize(wo + wi);
        const float density = in->coat.density(h), weight = PrincipledInputs::schlick_weight(cos_h);
        const float fresnel = 0.04f * (1.0f - weight) + weight;
        result.f_cos +=
            Rgb(0.25f * in->clearcoat * fresnel * density * ClearCoat::masking(wo) * ClearCoat::masking(wi) * wi.z);
        result.pdf += probability * density * h.z / (4.0f * cos_h);
    }
};

template <>
struct BsdfNeeds<PrincipledMaterial> : NoBsdfNeeds {
    using Kept = PrincipledInputs;
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const PrincipledMaterial& m, const Context& at) {
    PrincipledInputs in;
    in.base = at.color(m.base_color);
    in.roughness = at.fraction(m.roughness);
    in.metallic = at.fraction(m.metallic);
    in.spec_trans = at.fraction(m.spec_trans);
    in.spec_tint = at.fraction(m.spec_tint);
    in.sheen = at.fraction(m.sheen);
    in.sheen_tint = at.fraction(m.sheen_tint);
    in.flatness = at.fraction(m.flatness);
    in.clearcoat = at.fraction(m.clearcoat);
    in.coat = ClearCoat::of(at.fraction(m.clearcoat_gloss));
    in.eta = at.back ? 1.0f / m.eta : m.eta;
    in.facets = PrincipledInputs::facets_of(in.roughness, at.fraction(m.anisotropic));
    if (at.back && !(in.spec_trans > 0.0f)) return {};
    return {PrincipledBsdf{at.keep(in), at.back}};
}

}  // namespace treefarm
