// SPDX-License-Identifier: Apache-2.0
#include "tests/support/light_checks.h"

#include <gtest/gtest.h>

#include "common/math/frame.h"
#include "common/math/warp.h"
#include "common/plan/resolve/resolve.h"
#include "tests/support/chi_square.h"
#include "worker/integrators/subpath/mis.h"
#include "worker/scene/trace_scene.h"

namespace treefarm::test {
namespace {

constexpr double kSignificance = 1e-4;

/// Radiance carried by an unoccluded sample.
Rgb arriving(const Emitters& emitters, const DirectSample& s) {
    return s.from_environment ? emitters.environment(s.wi) : s.radiance;
}

}  // namespace

void expect_light_distribution(const Scene& scene, const Vec3& p, const std::string& what, float min_cosine) {
    const TraceScene lights(scene, {});
    const auto sample = [&](std::uint32_t i, Vec3& d) {
        const DirectSample s = lights.emitters().sample_direct(p, draw({3, i, 0}, 1, Stream::light));
        d = s.wi;
        if (!(s.pdf > 0.0f) || is_black(arriving(lights.emitters(), s))) return false;
        if (s.at_infinity()) return !lights.geometry().occluded({p, s.wi});
        if (-dot(s.on_light.ng, s.wi) < min_cosine) return false;
        Hit hit;
        return lights.geometry().intersect({p, s.wi, s.distance * 0.999f}, hit) == false ||
               hit.shape == s.on_light.shape;
    };
    const auto density = [&](const Vec3& d) -> double {
        Hit hit;
        if (!lights.geometry().intersect({p, d}, hit))
            return is_black(lights.emitters().environment(d)) ? 0.0 : lights.emitters().pdf_environment(p, d);
        if (-dot(hit.ng, d) < min_cosine) return 0.0;
        return is_black(lights.emitters().emitted(hit, -d)) ? 0.0 : lights.emitters().pdf_direct(p, d, hit);
    };
    const auto result = test_directions(sample, density, 200000, 16, 96);
    EXPECT_NEAR(result.integral, result.success, 5e-3) << what;
    EXPECT_GT(result.p_value, kSignificance) << what;
}

Irradiance irradiance(const Scene& scene, const Vec3& p, const Vec3& n, std::uint32_t samples) {
    const TraceScene lights(scene, {});
    const Emitters& emitters = lights.emitters();
    const Frame frame(n);
    double sums[4] = {0, 0, 0, 0};
    for (std::uint32_t i = 0; i < samples; ++i) {
        const DirectSample s = emitters.sample_direct(p, draw({9, i, 0}, 1, Stream::light));
        const float cosine = dot(n, s.wi);
        double light = 0, both = 0;
        if (s.pdf > 0.0f && cosine > 0.0f) {
            light = double(average(arriving(emitters, s))) * double(cosine) / double(s.pdf);
            const float other = s.delta ? 0.0f : cosine_hemisphere_pdf(cosine);
            both = light * double(mis_weight(MisHeuristic::power, s.pdf, other));
        }
        const Draw r = draw({9, i, 0}, 1, Stream::scatter);
        const Vec3 d = square_to_cosine_hemisphere({to_unit(r[2]), to_unit(r[3])});
        const Vec3 wi = frame.to_world(d);
        const float pdf = cosine_hemisphere_pdf(d.z);
        Hit hit;
        if (lights.geometry().intersect({p, wi}, hit))
            both += double(average(emitters.emitted(hit, -wi))) * M_PI *
                    double(mis_weight(MisHeuristic::power, pdf, emitters.pdf_direct(p, wi, hit)));
        else
            both += double(average(emitters.environment(wi))) * M_PI *
                    double(mis_weight(MisHeuristic::power, pdf, emitters.pdf_environment(p, wi)));
        sums[0] += light;
        sums[1] += light * light;
        sums[2] += both;
        sums[3] += both * both;
    }
    const double n_samples = samples;
    const auto error = [&](double sum, double sum2) {
        return std::sqrt(std::max(0.0, sum2 / n_samples - sum * sum / n_samples / n_samples) / n_samples);
    };
    return {sums[0] / n_samples, error(sums[0], sums[1]), sums[2] / n_samples, error(sums[2], sums[3])};
}

void expect_irradiance(const Scene& scene, const Vec3& p, const Vec3& n, double exact, const std::string& what) {
    const Irradiance e = irradiance(scene, p, n, 200000);
    EXPECT_NEAR(e.light, exact, 4.5 * e.light_error + 2e-4 * exact) << what << ", light sampling";
    EXPECT_NEAR(e.both, exact, 4.5 * e.both_error + 2e-4 * exact) << what << ", both";
}

}  // namespace treefarm::test
