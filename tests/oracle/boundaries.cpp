// SPDX-License-Identifier: Apache-2.0
#include "tests/oracle/oracle.h"
#include "worker/shading/fresnel.h"

namespace treefarm::oracle {
namespace {

struct Exact {
    Quad reflectance, cos_t;
};

Exact exact_dielectric(Quad c, Quad eta) {
    const Quad sin2 = (1 - c) * (1 + c) / (eta * eta);
    if (sin2 >= 1) return {1, 0};
    const Quad t = sqrtq(1 - sin2), s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
    return {(s * s + p * p) / 2, t};
}

/// (cos - N cos_t) / (cos + N cos_t) with complex N = eta + i k, and its parallel counterpart.
Quad exact_conductor(Quad c, Quad eta, Quad k) {
    const Quad c2 = c * c, s2 = 1 - c2, re = eta * eta - k * k - s2;
    const Quad ab = sqrtq(re * re + 4 * eta * eta * k * k);
    // The root's real part: of (ab + re) / 2, by its conjugate where that cancels.
    const Quad half = re >= 0 ? (ab + re) / 2 : 2 * eta * eta * k * k / (ab - re);
    const Quad a = sqrtq(half), se = ab + c2, so = 2 * a * c, rs = (se - so) / (se + so);
    const Quad pe = ab * c2 + s2 * s2, po = so * s2;
    return rs * (1 + (pe - po) / (pe + po)) / 2;
}

}  // namespace

void boundaries(std::uint64_t count, std::vector<Row>& rows) {
    Row glass{"Fresnel, dielectric, 3 % of sin^2 and more from total reflection", "absolute", 3e-6};
    Row direction{"the same: cosine of the refracted ray", "relative", 3e-6};
    Row edge{"Fresnel, dielectric, up to the edge", "of reflectances for sines that differ by 4e-7", 2e-6};
    Row metal{"Fresnel, conductor, eta and k from 1e-3 to 1e3", "absolute", 3e-5};
    Inputs in(4);
    for (std::uint64_t i = 0; i < count; ++i) {
        const float eta =
            in.chance(0.3f) ? 1.0f + in.scale(1e-4f, 1e-1f) * (in.chance(0.5f) ? 1.0f : -1.0f) : in.scale(0.25f, 4.0f);
        const float cos = in.chance(0.5f)   ? in.uniform(0.0f, 1.0f)
                          : in.chance(0.5f) ? in.scale(1e-8f, 1.0f)
                                            : 1.0f - in.scale(1e-7f, 1.0f);
        const DielectricFresnel ours = fresnel_dielectric(cos, eta);
        const Exact exact = exact_dielectric(Quad(cos), Quad(eta));
        const Quad sin2 = (1 - Quad(cos)) * (1 + Quad(cos)) / (Quad(eta) * Quad(eta));
        if (fabsq(sin2 - 1) > Quad(0.03)) {
            glass.see(absolute(ours.reflectance, exact.reflectance), cos, eta);
            if (exact.cos_t > 0) direction.see(relative(ours.cos_transmitted, exact.cos_t), cos, eta);
        }
        // Between what slightly smaller and larger indices give.
        const Quad low = exact_dielectric(Quad(cos), Quad(eta) * (1 - 2e-7Q)).reflectance;
        const Quad high = exact_dielectric(Quad(cos), Quad(eta) * (1 + 2e-7Q)).reflectance;
        const Quad value = ours.reflectance;
        const Quad below = fminq(low, fminq(high, exact.reflectance)),
                   above = fmaxq(low, fmaxq(high, exact.reflectance));
        edge.see(static_cast<double>(fmaxq(0, fmaxq(below - value, value - above))), cos, eta);
        const float n = in.scale(1e-3f, 1e3f), k = in.scale(1e-3f, 1e3f);
        metal.see(absolute(fresnel_conductor(cos, n, k), exact_conductor(Quad(cos), Quad(n), Quad(k))), cos, n, k);
    }
    rows.insert(rows.end(), {glass, direction, edge, metal});
}

}  // namespace treefarm::oracle
