#include <gtest/gtest.h>

#include "common/math/warp.h"
#include "tests/support/chi_square.h"
#include "tests/support/test_scenes.h"
#include "worker/integrator/mis.h"
#include "worker/lights/emitters.h"

namespace treefarm {
namespace {

using test::add_shape;
using test::quad;

constexpr double kSignificance = 1e-4;

struct Lights {
    explicit Lights(const Scene& scene)
        : geometry(scene.shapes, "avx2"), emitters(scene.emitters, geometry, scene.bounds()) {}
    EmbreeScene geometry;
    Emitters emitters;
};

Scene only(decltype(Shape::geometry) geometry) {
    Scene scene;
    add_shape(scene, std::move(geometry), kNone, Rgb(1.0f));
    return scene;
}

/// Directions of sample_direct that really reach the light first, against pdf_direct of what rays in those directions
/// hit.
void expect_agreement(const Scene& scene, const Vec3& p, const std::string& what) {
    const Lights lights(scene);
    const auto sample = [&](std::uint32_t i, Vec3& d) {
        const DirectSample s = lights.emitters.sample_direct(p, draw({3, i, 0}, 1, Stream::light));
        d = s.wi;
        if (!(s.pdf > 0.0f) || is_black(s.radiance)) return false;
        if (s.to_environment()) return !lights.geometry.occluded({p, s.wi});
        Hit hit;
        return lights.geometry.intersect({p, s.wi, s.distance * 0.999f}, hit) == false || hit.shape == s.on_light.shape;
    };
    const auto density = [&](const Vec3& d) -> double {
        Hit hit;
        if (!lights.geometry.intersect({p, d}, hit)) return lights.emitters.pdf_environment(d);
        return is_black(lights.emitters.emitted(hit, -d)) ? 0.0 : lights.emitters.pdf_direct(p, d, hit);
    };
    const auto result = test::test_directions(sample, density, 200000, 16, 96);
    EXPECT_NEAR(result.integral, result.success, 5e-3) << what;
    EXPECT_GT(result.p_value, kSignificance) << what;
}

TEST(LightDistribution, Rectangle) {
    expect_agreement(only(quad({-2, -2, 1.5f}, {0, 4, 0}, {4, 0, 0})), Vec3(0.3f, 0.1f, 0), "rectangle");
}

TEST(LightDistribution, ConvexMesh) {
    expect_agreement(only(test::box(Vec3(-1, -1, 1), Vec3(1.5f, 1, 2), false)), Vec3(0.2f, 0.1f, -0.2f), "box");
}

TEST(LightDistribution, RoomSeenFromInside) {
    expect_agreement(only(test::box(Vec3(-1, -1.5f, -1), Vec3(1, 1, 2), true)), Vec3(0.2f, 0.1f, -0.2f), "room");
}

TEST(LightDistribution, SphereFromOutside) {
    expect_agreement(only(Sphere{Vec3(1, 2, 3), 2.5f, false}), Vec3(0.0f), "sphere");
}

TEST(LightDistribution, SphereFromInside) {
    expect_agreement(only(Sphere{Vec3(0.3f, 0.2f, 0.1f), 2.5f, true}), Vec3(1.0f, 0.5f, 0), "inside a sphere");
}

TEST(LightDistribution, Environment) {
    Scene scene;
    add_shape(scene, quad({-1, -1, 1}, {2, 0, 0}, {0, 2, 0}), kNone);
    scene.emitters.push_back({ConstantEmitter{Rgb(1.0f)}, {}});
    expect_agreement(scene, Vec3(0.0f), "environment");
}

TEST(LightDistribution, SeveralAtOnce) {
    Scene scene = only(quad({-2, -2, 2}, {0, 4, 0}, {4, 0, 0}));
    add_shape(scene, Sphere{Vec3(3, 0, 0), 1.0f, false}, kNone, Rgb(2.0f));
    scene.emitters.push_back({ConstantEmitter{Rgb(0.5f)}, {}});
    expect_agreement(scene, Vec3(0.1f, 0.2f, 0), "several");
}

/// Irradiance at p on a surface facing n, by sampling the lights alone, the cosine alone, or both.
struct Irradiance {
    double light = 0, light_error = 0, both = 0, both_error = 0;
};

Irradiance irradiance(const Scene& scene, const Vec3& p, const Vec3& n, std::uint32_t samples) {
    const Lights lights(scene);
    const Frame frame(n);
    double sums[4] = {0, 0, 0, 0};
    for (std::uint32_t i = 0; i < samples; ++i) {
        const DirectSample s = lights.emitters.sample_direct(p, draw({9, i, 0}, 1, Stream::light));
        const float cosine = dot(n, s.wi);
        double light = 0, both = 0;
        if (s.pdf > 0.0f && cosine > 0.0f) {
            light = double(average(s.radiance)) * cosine / s.pdf;
            both = light * mis_weight(MisHeuristic::power, s.pdf, cosine_hemisphere_pdf(cosine));
        }
        const Draw r = draw({9, i, 0}, 1, Stream::scatter);
        const Vec3 d = square_to_cosine_hemisphere({to_unit(r[2]), to_unit(r[3])});
        const Vec3 wi = frame.to_world(d);
        Hit hit;
        if (lights.geometry.intersect({p, wi}, hit)) {
            const float pdf = cosine_hemisphere_pdf(d.z);
            both += double(average(lights.emitters.emitted(hit, -wi))) * M_PI *
                    mis_weight(MisHeuristic::power, pdf, lights.emitters.pdf_direct(p, wi, hit));
        }
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

/// Form factor from a small patch to a parallel rectangle a x b at distance h above its corner (Howell's catalogue,
/// B-3).
double corner_form_factor(double a, double b, double h) {
    const double x = a / h, y = b / h;
    const double rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * M_PI);
}

void expect_irradiance(const Scene& scene, const Vec3& p, const Vec3& n, double exact, const std::string& what) {
    const Irradiance e = irradiance(scene, p, n, 200000);
    EXPECT_NEAR(e.light, exact, 4.5 * e.light_error + 2e-4 * exact) << what << ", light sampling";
    EXPECT_NEAR(e.both, exact, 4.5 * e.both_error + 2e-4 * exact) << what << ", both";
}

TEST(LightIrradiance, ParallelRectangles) {
    for (const double size : {1e-3, 1.0, 1e3})
        for (const double ratio : {0.03, 1.0, 30.0}) {
            const double h = size / ratio;
            const auto s = static_cast<float>(size);
            const Scene scene = only(quad({0, 0, float(h)}, {0, s, 0}, {s, 0, 0}));
            const double exact =
                M_PI *
                (corner_form_factor(0.25 * size, 0.5 * size, h) + corner_form_factor(0.75 * size, 0.5 * size, h)) * 2;
            expect_irradiance(scene, Vec3(0.25f * s, 0.5f * s, 0), Vec3(0, 0, 1), exact,
                              "size " + std::to_string(size) + " ratio " + std::to_string(ratio));
        }
}

TEST(LightIrradiance, Spheres) {
    const Vec3 n = normalize(Vec3(0.5f, 0.2f, 1));
    for (const double radius : {1e-3, 0.5, 1e3})
        for (const double ratio : {1e-3, 0.1, 0.6}) {
            const double distance = radius / ratio;
            const Scene scene = only(Sphere{Vec3(0, 0, float(distance)), float(radius), false});
            // The whole sphere is above the horizon of n: the cosine at its centre times the projected disk.
            expect_irradiance(scene, Vec3(0.0f), n, M_PI * ratio * ratio * n.z,
                              "radius " + std::to_string(radius) + " ratio " + std::to_string(ratio));
        }
}

TEST(LightIrradiance, InsideASphere) {
    expect_irradiance(only(Sphere{Vec3(1, 1, 1), 3.0f, true}), Vec3(2, 0.5f, 1), Vec3(0, 0, 1), M_PI, "inside");
}

TEST(LightIrradiance, TessellatedSphereComesCloseToTheTrueOne) {
    const Scene scene = only(test::sphere_mesh(Vec3(0, 0, 4), 1.0f, 5, true));
    const Irradiance e = irradiance(scene, Vec3(0.0f), Vec3(0, 0, 1), 200000);
    EXPECT_NEAR(e.both, M_PI / 16, 4.5 * e.both_error + 2e-3 * M_PI / 16);
}

}  // namespace
}  // namespace treefarm
