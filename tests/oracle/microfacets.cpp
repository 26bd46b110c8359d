// SPDX-License-Identifier: Apache-2.0
#include "common/math/exponential.h"
#include "tests/oracle/oracle.h"
#include "worker/shading/rough_reflection.h"

namespace treefarm::oracle {
namespace {

Quad exact_density(const Microfacet& m, const Quad h[3]) {
    const Quad x = h[0] / Quad(m.alpha_u), y = h[1] / Quad(m.alpha_v), z2 = h[2] * h[2];
    const Quad length2 = h[0] * h[0] + h[1] * h[1] + z2, area = M_PIq * Quad(m.alpha_u) * Quad(m.alpha_v);
    if (m.ggx) {
        const Quad ratio = length2 / (x * x + y * y + z2);
        return ratio * ratio / area;
    }
    const Quad ratio = length2 / z2;
    return expq(-(x * x + y * y) / z2) * ratio * ratio / area;
}

Quad exact_density(const Microfacet& m, const Vec3& v) {
    const Quad h[3] = {Quad(v.x), Quad(v.y), Quad(v.z)};
    return exact_density(m, h);
}

Quad exact_area(const Microfacet& m, const Vec3& w) {
    const Quad x = Quad(m.alpha_u) * Quad(w.x), y = Quad(m.alpha_v) * Quad(w.y), z = Quad(w.z);
    const Quad r2 = x * x + y * y, r = sqrtq(r2);
    if (m.ggx) return (z + sqrtq(z * z + r2)) / 2;
    if (r == 0) return z;
    const Quad a = z / r;
    return z * erfcq(-a) / 2 + r * expq(-a * a) / (2 * sqrtq(M_PIq));
}

}  // namespace

void microfacets(std::uint64_t count, std::vector<Row>& rows) {
    for (const bool ggx : {true, false}) {
        const std::string name = ggx ? "GGX" : "Beckmann";
        // Beckmann's tail is an exponential: its argument's rounding counts up to 87 times.
        Row density{name + ": D", "relative", ggx ? 1e-6 : 5e-5};
        Row area{name + ": projected area", "relative", 2e-6};
        Row pdf{name + ": density of reflected directions", "relative", ggx ? 3e-6 : 5e-5};
        Inputs in(ggx ? 1 : 2);
        for (std::uint64_t i = 0; i < count; ++i) {
            const float alpha = in.scale(1e-4f, 2.0f);
            const Microfacet m{ggx, alpha, in.chance(0.5f) ? alpha : in.scale(1e-4f, 2.0f)};
            // Facets where D is not negligible: slopes of some alphas.
            const Vec3 slope(m.alpha_u * in.uniform(-5, 5), m.alpha_v * in.uniform(-5, 5), 1.0f);
            const Vec3 h = in.chance(0.5f) ? normalize(slope) : slope * in.scale(1e-3f, 1e3f);
            const Quad exact = exact_density(m, h);
            if (exact > Quad(1e-25)) density.see(relative(m.density(h), exact), m.alpha_u, m.alpha_v, h);
            const Vec3 wo = in.hemisphere();
            area.see(relative(m.projected_area(wo), exact_area(m, wo)), m.alpha_u, m.alpha_v, wo);
            const Vec3 wi = reflected(wo, normalize(slope));
            if (!(wi.z > 0.0f)) continue;
            const Vec3 sum = wo + wi;
            if (!(dot(sum, sum) > 1e-4f)) continue;  // the half vector is what rounding left of it
            const Quad of_sum = exact_density(m, sum) / (4 * exact_area(m, wo));
            if (of_sum > Quad(1e-25) && of_sum < Quad(1e30))
                pdf.see(relative(rough_reflection(m, wo, wi).pdf, of_sum), m.alpha_u, m.alpha_v, wo, wi);
        }
        rows.insert(rows.end(), {density, area, pdf});
    }
    Row exponential{"exp(-x), x from 0 to 86", "relative", 5e-7},
        erfc{"exp(x^2) erfc(x), x from 0 to 1e4", "relative", 6e-7};
    Inputs in(3);
    for (std::uint64_t i = 0; i < count; ++i) {
        const float x = in.chance(0.5f) ? in.uniform(0.0f, 86.0f) : in.scale(1e-8f, 86.0f);
        exponential.see(relative(exp_negative(x), expq(-Quad(x))), x);
        const float y = in.scale(1e-6f, 50.0f);
        erfc.see(relative(erfc_scaled(y), expq(Quad(y) * Quad(y)) * erfcq(Quad(y))), y);
    }
    erfc.what = "exp(x^2) erfc(x), x from 0 to 50";
    rows.insert(rows.end(), {exponential, erfc});
}

}  // namespace treefarm::oracle
