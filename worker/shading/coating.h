// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/exponential.h"
#include "common/scene/kinds/materials/coating.h"
#include "worker/shading/bsdf_needs.h"
#include "worker/shading/coat.h"
#include "worker/shading/fresnel.h"
#include "worker/shading/rough_reflection.h"
#include "worker/shading/rough_transmittance.h"

namespace treefarm {

struct Bsdf;

/// A BSDF seen through a flat dielectric layer: directions are refracted, light is absorbed on its way, and solid
/// angles shrink. The boundary's transmittance is left to the coats below.
struct LayeredBsdf {
    float eta = 1.5f;  ///< of the layer over that of the outside
    Rgb absorption{0.0f};
    const Bsdf* beneath = nullptr;  ///< lives as long as the materials, or as the hit

    LobeBits lobes() const;
    float refraction() const;

    /// f cos and density of the light that passes the boundary along both directions, for a boundary of transmittance
    /// 1.
    inline BsdfValue value(const Vec3& wo, const Vec3& wi) const;
    /// Sample of the inner BSDF, with wi refracted to the outside. A smooth lobe's value and density are those inside:
    /// value() returns those outside.
    inline BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const;

    /// w refracted by a relative index of `ratio`, on the same side; z is 0 at total reflection.
    static Vec3 refracted(const Vec3& w, float ratio) {
        const float x = w.x / ratio, y = w.y / ratio, cos2 = 1.0f - (x * x + y * y);
        return {x, y, cos2 > 0.0f ? std::copysign(std::sqrt(cos2), w.z) : 0.0f};
    }
    /// Transmittance of the layer along the two directions inside.
    Rgb absorbed(const Vec3& wo, const Vec3& wi) const {
        if (is_black(absorption)) return Rgb(1.0f);
        const float length = 1.0f / wo.z + 1.0f / std::abs(wi.z);
        return {exp_negative(absorption.x * length), exp_negative(absorption.y * length),
                exp_negative(absorption.z * length)};
    }
};

/// A smooth coat over a BSDF.
struct CoatingBsdf {
    LayeredBsdf layer;
    Rgb specular{1.0f};
    float specular_weight = 0.5f;  ///< affects sampling only

    LobeBits lobes() const { return static_cast<LobeBits>(layer.lobes() | kDeltaLobe); }
    float refraction() const { return layer.refraction(); }

    /// Value and density; out of line, as those of dielectrics.
    [[gnu::noinline]] BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        const float reflected = reflectance(wo);
        BsdfValue v = layer.value(wo, wi);
        v.f_cos *= (1.0f - reflected) * (1.0f - reflectance(wi));
        v.pdf *= 1.0f - coat_probability(reflected, specular_weight);
        return v;
    }

    [[gnu::noinline]] BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const float reflected = reflectance(wo), mirror = coat_probability(reflected, specular_weight);
        if (random.lobe < mirror) return {{-wo.x, -wo.y, wo.z}, mirror, specular * reflected, true};
        const float rest = std::min((random.lobe - mirror) / (1.0f - mirror), 0x1.fffffep-1f);
        BsdfSample s = layer.sample(wo, {rest, random.point, random.cosine});
        if (!(s.pdf > 0.0f)) return {};
        if (s.delta) {
            s.f_cos *= (1.0f - reflected) * (1.0f - reflectance(s.wi));
            s.pdf *= 1.0f - mirror;
            return s;
        }
        const BsdfValue v = value(wo, s.wi);
        return {s.wi, v.pdf, v.f_cos, false};
    }

  private:
    float reflectance(const Vec3& w) const {
        return fresnel_dielectric(std::min(1.0f, std::abs(w.z)), layer.eta).reflectance;
    }
};

/// A rough coat over a BSDF. Directions are refracted as by a smooth coat, and the boundary has the mean transmittance
/// of its facets.
struct RoughCoatingBsdf {
    LayeredBsdf layer;
    Rgb specular{1.0f};
    float specular_weight = 0.5f;  ///< affects sampling only
    bool ggx = true;               ///< otherwise Beckmann's facets
    float alpha = 0.1f;
    const RoughTransmittance* passes = nullptr;

    LobeBits lobes() const { return static_cast<LobeBits>(layer.lobes() | kSmoothLobe | kViewLobe); }
    float refraction() const { return layer.refraction(); }

    [[gnu::noinline]] BsdfValue value(const Vec3& wo, const Vec3& wi) const {
        const float out = passes->at(wo.z), coat = coat_probability(1.0f - out, specular_weight);
        BsdfValue v = layer.value(wo, wi);
        v.f_cos *= out * passes->at(std::min(1.0f, std::abs(wi.z)));
        v.pdf *= 1.0f - coat;
        if (!(wi.z > 0.0f)) return v;
        const RoughReflection r = rough_reflection(facets(), wo, wi);
        v.f_cos += specular * (fresnel_dielectric(r.cos_o, layer.eta).reflectance * r.f_cos);
        v.pdf += coat * r.pdf;
        return v;
    }

    [[gnu::noinline]] BsdfSample sample(const Vec3& wo, const BsdfRandom& random) const {
        const float out = passes->at(wo.z), coat = coat_probability(1.0f - out, specular_weight);
        Vec3 wi;
        if (random.lobe < coat) {
            wi = reflected(wo, facets().sample_visible(wo, random.point));
            if (!(wi.z > 0.0f)) return {};
        } else {
            const float rest = std::min((random.lobe - coat) / (1.0f - coat), 0x1.fffffep-1f);
            BsdfSample s = layer.sample(wo, {rest, random.point, random.cosine});
            if (!(s.pdf > 0.0f)) return {};
            if (s.delta) {
                s.f_cos *= out * passes->at(std::min(1.0f, std::abs(s.wi.z)));
                s.pdf *= 1.0f - coat;
                return s;
            }
            wi = s.wi;
        }
        const BsdfValue v = value(wo, wi);
        return {wi, v.pdf, v.f_cos, false};
    }

  private:
    Microfacet facets() const { return {ggx, alpha, alpha}; }
};

template <>
struct BsdfNeeds<CoatingMaterial> : NoBsdfNeeds {
    static constexpr bool kCoat = true;
};

/// BSDF of the material at one point of a surface (bsdf_builder.h).
template <class Context>
typename Context::Result make_bsdf(const CoatingMaterial& m, const Context& at) {
    const Rgb absorption = at.amount(m.absorption), specular = at.color(m.specular_reflectance);
    const LayeredBsdf layer{m.eta, absorption, at.part(m.coated)};
    // Light from beneath has passed the coat twice.
    const float back = average(
        {exp_negative(2.0f * absorption.x), exp_negative(2.0f * absorption.y), exp_negative(2.0f * absorption.z)});
    const float weight = 1.0f / (1.0f + back);
    if (m.roughness.smooth()) return {CoatingBsdf{layer, specular, weight}};
    const Microfacet rough = at.facets(m.roughness);
    return {RoughCoatingBsdf{layer, specular, weight, rough.ggx, rough.alpha_u, at.coat(rough)}};
}

}  // namespace treefarm
