// SPDX-License-Identifier: Apache-2.0
#include "worker/shading/rough_transmittance.h"

#include "common/math/elementary.h"
#include "common/math/exponential.h"
#include "worker/shading/fresnel.h"
#include "worker/shading/rough_reflection.h"

namespace treefarm {
namespace {

/// A uniform number mapped to one that is dense near both ends, where normals of the distribution's tail are, and the
/// map's derivative.
struct Graded {
    float value, weight;
};

Graded graded(int i, int count) {
    const float t = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
    return {t * t * (3.0f - 2.0f * t), 6.0f * t * (1.0f - t)};
}

Vec3 at_cosine(float cos) {
    return {std::sqrt((1.0f - cos) * (1.0f + cos)), 0.0f, cos};
}

/// Mean over visible normals of a facet's transmittance along `wo`, times the masking of the transmitted direction.
/// Accurate to about 1e-3.
float transmitted(const Microfacet& facets, float eta, const Vec3& wo) {
    const int steps = facets.ggx ? 24 : 16;  // GGX has the longer tails, and costs less
    double sum = 0, weights = 0;
    for (int j = 0; j < steps; ++j)
        for (int i = 0; i < steps; ++i) {
            const Graded along = graded(i, steps), across = graded(j, steps);
            const auto weight = double(along.weight * across.weight);
            weights += weight;
            const Vec3 m = facets.sample_visible(wo, {along.value, across.value});
            const float cos_o = std::min(1.0f, dot(wo, m));
            if (!(cos_o > 0.0f)) continue;
            const DielectricFresnel f = fresnel_dielectric(cos_o, eta);
            const Vec3 wi = refract(wo, m, cos_o, f.cos_transmitted, eta);
            if (f.reflectance < 1.0f && wi.z < 0.0f)
                sum += weight * double((1.0f - f.reflectance) * facets.masking({wi.x, wi.y, -wi.z}));
        }
    return static_cast<float>(sum / weights);
}

/// A facet's normal, and the fraction of the surface under such facets.
struct Facet {
    Vec3 normal;
    float fraction;
};

/// Facets of half a turn, by midpoints in slope and azimuth; the other half is mirrored. They cost much less than
/// visible normals, so that there can be enough of them to resolve the edge of total reflection.
std::vector<Facet> representative_facets(const Microfacet& facets) {
    constexpr int kSlopes = 96, kAzimuths = 32;
    std::vector<Facet> result;
    float total = 0.0f;
    for (int i = 0; i < kSlopes; ++i) {
        const float u = (static_cast<float>(i) + 0.5f) / kSlopes;
        // Slopes over alpha: GGX's at equal probability, Beckmann's, whose tail is short, at equal distances.
        const float slope = facets.ggx ? std::sqrt(u / (1.0f - u)) : 4.0f * u;
        const float fraction = facets.ggx ? 1.0f : slope * exp_negative(slope * slope);
        for (int j = 0; j < kAzimuths; ++j) {
            const SinCos turn = sincos_turn(0.5f * (static_cast<float>(j) + 0.5f) / kAzimuths);
            const float tilt = slope * facets.alpha_u;
            result.push_back({normalize(Vec3(tilt * turn.cos, tilt * turn.sin, 1.0f)), fraction});
            total += fraction;
        }
    }
    for (Facet& facet : result)
        facet.fraction /= total;
    return result;
}

/// Diffuse light that the boundary reflects once, seen from inside. The sum over 64 equidistant cosines is Mitsuba 3's
/// (roughplastic.cpp); it is up to 1.6 % below the integral.
float diffuse_reflected_once(const Microfacet& facets, float eta) {
    constexpr int kCosines = 64;
    const std::vector<Facet> normals = representative_facets(facets);
    double sum = 0;
    for (int i = 1; i < kCosines; ++i) {
        const Vec3 wo = at_cosine(static_cast<float>(i) / (kCosines - 1));
        float reflected_fraction = 0.0f;
        for (const auto& [m, fraction] : normals) {
            const float cos_o = std::min(1.0f, dot(wo, m));
            if (!(cos_o > 0.0f)) continue;
            const Vec3 wi = reflected(wo, m);
            if (wi.z > 0.0f)
                reflected_fraction +=
                    fraction * cos_o / m.z * fresnel_dielectric(cos_o, eta).reflectance * facets.masking(wi);
        }
        sum += 2.0 * double(wo.z) * double(reflected_fraction / facets.projected_area(wo));
    }
    return static_cast<float>(sum / kCosines);
}

}  // namespace

RoughTransmittance::RoughTransmittance(const Microfacet& facets, float eta) {
    double diffuse = 0;
    for (std::size_t i = 0; i <= kIntervals; ++i) {
        const float root = static_cast<float>(i) / static_cast<float>(kIntervals);
        values_[i] = transmitted(facets, eta, at_cosine(std::max(1e-6f, root * root)));
        // 2 cos dcos = 4 root^3 droot, by Simpson's rule.
        const double weight = i == 0 || i == kIntervals ? 1 : (i % 2 ? 4 : 2);
        diffuse +=
            weight / (3.0 * double(kIntervals)) * 4.0 * double(root) * double(root) * double(root) * double(values_[i]);
    }
    // By reciprocity the outward transmittance is the inward one times 1 / eta^2.
    escapes_all_ = static_cast<float>(diffuse) * (1.0f / (eta * eta));
    escapes_single_ = 1.0f - diffuse_reflected_once(facets, 1.0f / eta);
}

RoughTransmittance RoughTransmittance::between(const RoughTransmittance& a, const RoughTransmittance& b, float t) {
    RoughTransmittance mixed;
    for (std::size_t i = 0; i <= kIntervals; ++i)
        mixed.values_[i] = a.values_[i] + (b.values_[i] - a.values_[i]) * t;
    mixed.escapes_all_ = a.escapes_all_ + (b.escapes_all_ - a.escapes_all_) * t;
    mixed.escapes_single_ = a.escapes_single_ + (b.escapes_single_ - a.escapes_single_) * t;
    return mixed;
}

RoughTransmittances::RoughTransmittances(bool ggx, float eta) {
    for (int i = 0; i <= kIntervals; ++i) {
        const float root = static_cast<float>(i) / kIntervals;
        const float alpha = std::max(Microfacet::kMinAlpha, root * root);
        tables_.emplace_back(Microfacet{ggx, alpha, alpha}, eta);
    }
}

RoughTransmittance RoughTransmittances::at(float alpha) const {
    const float position = std::sqrt(std::clamp(alpha, 0.0f, 1.0f)) * kIntervals;
    const auto i = static_cast<std::size_t>(std::min(static_cast<int>(position), kIntervals - 1));
    return RoughTransmittance::between(tables_[i], tables_[i + 1], position - static_cast<float>(i));
}

float smooth_diffuse_transmittance(float eta) {
    // Midpoints in the root of the cosine, where the integrand is smooth even at total reflection's edge.
    constexpr int kSteps = 4096;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double root = (i + 0.5) / kSteps;
        const float cos = static_cast<float>(root * root);
        sum += double(1.0f - fresnel_dielectric(cos, eta).reflectance) * 4.0 * root * root * root;
    }
    return static_cast<float>(sum / kSteps);
}

}  // namespace treefarm
