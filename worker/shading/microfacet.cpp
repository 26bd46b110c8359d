// SPDX-License-Identifier: Apache-2.0
#include "worker/shading/microfacet.h"

#include "common/math/elementary.h"
#include "common/math/exponential.h"
#include "common/math/warp.h"

namespace treefarm {
namespace {

constexpr float kSqrtPi = 1.77245385090551602730f;

/// Integral of (cos - x sin) exp(-x^2) over slopes from minus infinity to `x`, and exp(-x^2): Beckmann's visible slopes
/// at alpha = 1, up to a factor. cos, sin >= 0.
struct VisibleSlopes {
    float integral, gaussian;
};

VisibleSlopes visible_slopes(float cos, float sin, float x) {
    const float gaussian = exp_negative(x * x);
    const float tail = 0.5f * kSqrtPi * gaussian * erfc_scaled(std::abs(x));  // beyond |x|
    const float normal = x < 0.0f ? tail : kSqrtPi - tail;
    return {cos * normal + 0.5f * sin * gaussian, gaussian};
}

/// Slope above which facets are rarer than the resolution of uniform numbers.
constexpr float kLargestSlope = 4.5f;

/// Quantile `u` of the visible slopes: Newton's method, within a shrinking bracket.
float sample_slope(float cos, float sin, float u) {
    float low = -kLargestSlope, high = cos < sin * kLargestSlope ? cos / sin : kLargestSlope;
    const float target = std::max(u, 0x1p-25f) * visible_slopes(cos, sin, high).integral;
    float x = std::min(0.0f, 0.5f * (low + high));
    if (u > 0.5f && high > 0.0f) x = 0.5f * std::min(high, 1.0f);
    for (int i = 0; i < 24; ++i) {
        const VisibleSlopes at = visible_slopes(cos, sin, x);
        const float excess = at.integral - target;
        (excess > 0.0f ? high : low) = x;
        const float slope = (cos - x * sin) * at.gaussian;
        float next = slope > 1e-30f ? x - excess / slope : low;
        if (!(next > low && next < high)) next = 0.5f * (low + high);
        const float step = std::abs(next - x);
        x = next;
        if (step < 1e-6f) break;
    }
    return x;
}

Vec3 beckmann_visible(const Vec3& stretched, const Vec2& u) {
    // Slope in the plane of incidence, and the independent one across it.
    const float sin = std::sqrt(stretched.x * stretched.x + stretched.y * stretched.y);
    const float along = sample_slope(stretched.z, sin, u.x);
    const float across = sample_slope(1.0f, 0.0f, u.y);
    const float cos_phi = sin > 0.0f ? stretched.x / sin : 1.0f, sin_phi = sin > 0.0f ? stretched.y / sin : 0.0f;
    return {-(cos_phi * along - sin_phi * across), -(sin_phi * along + cos_phi * across), 1.0f};
}

Vec3 ggx_visible(const Vec3& v, const Vec2& u) {
    const float sin2 = v.x * v.x + v.y * v.y;
    const float inverse = sin2 > 0.0f ? 1.0f / std::sqrt(sin2) : 0.0f;
    const Vec3 t1 = sin2 > 0.0f ? Vec3(-v.y * inverse, v.x * inverse, 0.0f) : Vec3(1.0f, 0.0f, 0.0f);
    const Vec3 t2 = cross(v, t1);
    const Vec2 d = square_to_disk(u);
    const float s = 0.5f * (1.0f + v.z);
    const float rest = std::max(0.0f, 1.0f - d.x * d.x);
    const float y = (1.0f - s) * std::sqrt(rest) + s * d.y;
    return t1 * d.x + t2 * y + v * std::sqrt(std::max(0.0f, rest - y * y));
}

}  // namespace

float Microfacet::density(const Vec3& h) const {
    const float x = h.x / alpha_u, y = h.y / alpha_v;
    const float area = kPi * alpha_u * alpha_v;
    const float length2 = dot(h, h), z2 = h.z * h.z;
    if (!(length2 > 0.0f)) return 0.0f;  // opposite directions along the surface
    if (ggx) {
        const float ratio = length2 / (x * x + y * y + z2);
        return ratio * ratio / area;
    }
    const float slope2 = x * x + y * y;  // times z2
    if (!(slope2 < 87.0f * z2)) return 0.0f;
    const float exponential = exp_negative(slope2 / z2);
    const float ratio = length2 / z2;
    return exponential * ratio * ratio / area;
}

float Microfacet::projected_area(const Vec3& w) const {
    const float x = alpha_u * w.x, y = alpha_v * w.y;
    const float r2 = x * x + y * y;
    if (ggx) return 0.5f * (w.z + std::sqrt(w.z * w.z + r2));
    const float r = std::sqrt(r2);
    if (w.z >= kLargestSlope * r) return w.z;
    return visible_slopes(w.z, r, w.z / r).integral / kSqrtPi;
}

Vec3 Microfacet::sample_visible(const Vec3& wo, const Vec2& u) const {
    const Vec3 stretched = normalize(Vec3(alpha_u * wo.x, alpha_v * wo.y, wo.z));
    const Vec3 n = ggx ? ggx_visible(stretched, u) : beckmann_visible(stretched, u);
    return normalize(Vec3(alpha_u * n.x, alpha_v * n.y, std::max(1e-7f, n.z)));
}

}  // namespace treefarm
