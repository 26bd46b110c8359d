#include "worker/shading/rough_transmittance.h"

#include "worker/shading/fresnel.h"

namespace treefarm {
namespace {

/// Mean over visible normals of what a facet transmits, times the masking of where it goes.
float transmitted(const Microfacet& facets, float eta, float cos) {
    constexpr int kAlong = 32, kAcross = 24;
    const Vec3 wo(std::sqrt((1.0f - cos) * (1.0f + cos)), 0.0f, cos);
    double sum = 0;
    for (int j = 0; j < kAcross; ++j)
        for (int i = 0; i < kAlong; ++i) {
            const Vec2 u((static_cast<float>(i) + 0.5f) / kAlong, (static_cast<float>(j) + 0.5f) / kAcross);
            const Vec3 m = facets.sample_visible(wo, u);
            const float cos_o = std::min(1.0f, dot(wo, m));
            if (!(cos_o > 0.0f)) continue;
            const DielectricFresnel f = fresnel_dielectric(cos_o, eta);
            const Vec3 wi = refract(wo, m, cos_o, f.cos_transmitted, eta);
            if (f.reflectance < 1.0f && wi.z < 0.0f)
                sum += double((1.0f - f.reflectance) * facets.masking({wi.x, wi.y, -wi.z}));
        }
    return static_cast<float>(sum / (kAlong * kAcross));
}

}  // namespace

RoughTransmittance::RoughTransmittance(const Microfacet& facets, float eta) {
    double diffuse = 0;
    for (std::size_t i = 0; i <= kIntervals; ++i) {
        const float root = static_cast<float>(i) / static_cast<float>(kIntervals);
        values_[i] = transmitted(facets, eta, std::max(1e-6f, root * root));
        // 2 cos dcos = 4 root^3 droot, by Simpson's rule.
        const double weight = i == 0 || i == kIntervals ? 1 : (i % 2 ? 4 : 2);
        diffuse +=
            weight / (3.0 * double(kIntervals)) * 4.0 * double(root) * double(root) * double(root) * double(values_[i]);
    }
    diffuse_ = static_cast<float>(diffuse);
}

RoughTransmittance RoughTransmittance::between(const RoughTransmittance& a, const RoughTransmittance& b, float t) {
    RoughTransmittance mixed;
    for (std::size_t i = 0; i <= kIntervals; ++i)
        mixed.values_[i] = a.values_[i] + (b.values_[i] - a.values_[i]) * t;
    mixed.diffuse_ = a.diffuse_ + (b.diffuse_ - a.diffuse_) * t;
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
    const float place = std::sqrt(std::clamp(alpha, 0.0f, 1.0f)) * kIntervals;
    const auto i = static_cast<std::size_t>(std::min(static_cast<int>(place), kIntervals - 1));
    return RoughTransmittance::between(tables_[i], tables_[i + 1], place - static_cast<float>(i));
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
