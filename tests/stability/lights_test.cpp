// SPDX-License-Identifier: Apache-2.0
// Emitters that are tiny, huge, distant, or hardly there.

#include "tests/support/hard_case.h"
#include "tests/support/light_checks.h"
#include "tests/support/map_parts.h"
#include "tests/support/material_scenes.h"
#include "worker/lights/emitters.h"
#include "worker/lights/environment_map.h"
#include "worker/lights/sphere_cone.h"

namespace treefarm {
namespace {

/// Irradiance at the origin, facing +z, by sampling the lights alone.
double sampled_irradiance(const Scene& scene, std::uint32_t samples) {
    const EmbreeScene geometry(scene.shapes, "avx2");
    const Emitters emitters(scene.emitters, geometry, scene.bounds());
    double sum = 0;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const DirectSample s = emitters.sample_direct(Vec3(0.0f), draw({5, i, 0}, 1, Stream::light));
        EXPECT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0.0f && is_finite(s.wi)) << s.pdf;
        if (s.pdf > 0.0f) sum += double(s.radiance.x) * std::max(0.0, double(s.wi.z)) / double(s.pdf);
    }
    return sum / samples;
}

/// 17 | Tiny, huge and distant spheres
/// Others: the solid angle as 1 - cos cancelled to 0 (Cycles 67410a3fa, 02445b9ab; pbrt 97c3b108).
/// Here: the cone is kept as 1 - cos, computed from the squared sine.
/// Holds: for radii 1e-6 to 1e3 at distances 1e-3 to 1e6 (radius below 0.95 of it), the irradiance by sampling is
/// pi (r/d)^2 within 0.5 %.
TEST(Lights, TinyAndDistantSpheres) {
    test::Worst worst;
    for (const double radius : {1e-6, 1e-3, 1.0, 1e3})
        for (const double distance : {1e-3, 1.0, 1e3, 1e6}) {
            if (radius > 0.95 * distance) continue;
            Scene scene;
            test::add_shape(scene, Sphere{Vec3(0, 0, float(distance)), float(radius)}, kNone, Rgb(1.0f));
            const double exact = M_PI * radius * radius / (distance * distance);
            worst.see(std::abs(sampled_irradiance(scene, 20000) / exact - 1.0), radius, distance);
        }
    EXPECT_LT(worst.value, 0.005) << worst.where;
    test::figure("largest relative error of the irradiance", worst.value);
}

/// 17 | Tiny, huge, skinny and distant quads
/// Others: densities of small, long or distant lights overflowed or cancelled (Cycles 3e77b0681; pbrt 906e8bd2).
/// Here: points are chosen uniformly by area in double, and the density is turned to the solid angle there.
/// Holds: sizes 1e-6 to 1e3, aspects up to 1e6, at distances 1e-3 to 1e6: the irradiance by sampling lies within 1
/// % of the integral over the light, by quadrature in double (lights are small as seen, or sampling is noise).
TEST(Lights, TinySkinnyAndDistantQuads) {
    test::Worst worst;
    for (const double size : {1e-6, 1e-3, 1.0, 1e3})
        for (const double aspect : {1.0, 1e3, 1e6})
            for (const double distance : {1e-3, 1.0, 1e3, 1e6}) {
                const double width = size / aspect;
                if (size > 2 * distance || width < 1e-9 * distance) continue;
                Scene scene;
                test::add_shape(scene,
                                test::quad({float(-size / 2), float(-width / 2), float(distance)}, {0, float(width), 0},
                                           {float(size), 0, 0}),
                                kNone, Rgb(1.0f));
                double exact = 0;
                constexpr int kSteps = 20000;
                for (int i = 0; i < kSteps; ++i) {
                    const double x = size * ((i + 0.5) / kSteps - 0.5), d2 = x * x + distance * distance;
                    exact += size * width / kSteps * distance * distance / (d2 * d2);
                }
                if (width > 0.01 * distance) continue;  // the quadrature is along the length only
                worst.see(std::abs(sampled_irradiance(scene, 20000) / exact - 1.0), size, aspect, distance);
            }
    EXPECT_LT(worst.value, 0.02) << worst.where;
    test::figure("largest relative error of the irradiance", worst.value);
}

/// 17 | Points on, in and next to a light
/// Others: distances of 0 gave densities of 0 and infinity.
/// Here: a sample at distance 0 is none; inside of a sphere its surface is sampled instead of its cone.
/// Holds: from points on a quad, its edges, its corner, a sphere's surface within +- 4 steps of float, its centre,
/// all samples are finite with densities of 0 or more, and unit directions where the density is above 0.
TEST(Lights, PointsOnTheLight) {
    Scene scene;
    test::add_shape(scene, test::quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), kNone, Rgb(1.0f));
    test::add_shape(scene, Sphere{Vec3(5, 0, 0), 1.0f}, kNone, Rgb(1.0f));
    Mesh point_like = test::quad({2, 2, 2}, {1e-18f, 0, 0}, {0, 1e-18f, 0});
    test::add_shape(scene, point_like, kNone, Rgb(1.0f));
    const EmbreeScene geometry(scene.shapes, "avx2");
    const Emitters emitters(scene.emitters, geometry, scene.bounds());
    std::vector<Vec3> points = {{0, 0, 0}, {0.5f, 0.5f, 0}, {1, 0, 0}, {0.5f, 0, 0}, {5, 0, 0}, {2, 2, 2}};
    float x = 6.0f;
    for (int i = 0; i < 4; ++i)
        x = std::nextafter(x, 0.0f);
    for (int i = 0; i < 9; ++i, x = std::nextafter(x, 10.0f))
        points.emplace_back(x, 0, 0);
    int samples = 0;
    for (const Vec3& p : points)
        for (std::uint32_t i = 0; i < 3000; ++i) {
            const DirectSample s = emitters.sample_direct(p, draw({6, i, 0}, 1, Stream::light));
            ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0.0f && is_finite(s.wi)) << p << s.pdf;
            if (s.pdf > 0.0f) {
                ASSERT_NEAR(s.wi.length(), 1.0f, 1e-5f) << p;
                ++samples;
            }
        }
    test::figure("samples with a density, of " + std::to_string(3000 * points.size()), samples);
}

/// 19 | The same decision made twice
/// Others: whether a direction met the sun was decided twice with different rounding: fireflies (Mitsuba 3 #1721).
/// Here: emission and the density of next event come from the same hit; a sampled point is the point that a ray
/// hits.
/// Holds: for 40,000 sampled directions towards a sphere's rim, a distant quad and the environment, whatever a ray
/// in that direction meets has a density above 0 exactly where it emits, and the mean of the weighted radiances of
/// both techniques together is the exact irradiance within 4.5 standard errors.
TEST(Lights, SampleAndHitAgree) {
    Scene scene;
    test::add_shape(scene, Sphere{Vec3(0, 0, 1000.0f), 4.65f}, kNone, Rgb(1.0f));
    const EmbreeScene geometry(scene.shapes, "avx2");
    const Emitters emitters(scene.emitters, geometry, scene.bounds());
    int met = 0, missed = 0;
    for (std::uint32_t i = 0; i < 40000; ++i) {
        Draw random = draw({7, i, 0}, 1, Stream::light);
        if (i % 2 == 0) random[2] |= 0xfffffe00u;  // the rim
        const DirectSample s = emitters.sample_direct(Vec3(0.0f), random);
        ASSERT_GT(s.pdf, 0.0f);
        Hit hit;
        if (!geometry.intersect({Vec3(0.0f), s.wi}, hit)) {
            ++missed;
            continue;
        }
        ++met;
        const float pdf = emitters.pdf_direct(Vec3(0.0f), s.wi, hit);
        ASSERT_EQ(pdf > 0.0f, !is_black(emitters.emitted(hit, -s.wi)));
        ASSERT_NEAR(pdf / s.pdf, 1.0f, 1e-5f);
    }
    EXPECT_LT(missed, 4000) << "of 20,000 within 2^-15 of the rim";
    EXPECT_GT(met, 36000);
    const double sine2 = std::pow(4.65 / 1000.0, 2);
    test::expect_irradiance(scene, Vec3(0.0f), Vec3(0, 0, 1), M_PI * sine2, "a sun");
    test::figure("of 20000 directions to the outermost 2^-15 miss", missed);
}

/// 14 | Very long rays
/// Others: points and spheres far away lost their digits (Mitsuba 3 #61, 0b483bff5; Cycles 9df1e5c09).
/// Here: a point is computed from what it lies on, not from the ray; neighbouring pixels of a long lens in double.
/// Holds: a checkerboard-like room seen from 1e4 of its sizes away through a lens 1e4 times as long has the mean of
/// the same room seen from near within 4.5 standard errors and 2 %.
TEST(Lights, FromTenThousandSizesAway) {
    const auto mean = [](float away) {
        Scene scene;
        const std::int32_t white = test::add_diffuse(scene, Rgb(0.8f), true);
        test::add_shape(scene, test::quad({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}), white);
        test::add_shape(scene, Sphere{{0.1f, 0.1f, 0.3f}, 0.2f}, white);
        test::add_shape(scene, test::quad({-0.5f, -0.5f, 2}, {0, 1, 0}, {1, 0, 0}), white, Rgb(3.0f));
        const Vec3 from = normalize(Vec3(3, -0.7f, 1)) * away;
        scene.camera = test::look_at(from, Vec3(0.0f), {0, 0, 1}, 0.6f / away);
        test::set_film(scene, 24, 24);
        const test::LocalRender run = test::render_locally(scene, test::plain_job(64, 4, NextEvent::always));
        EXPECT_EQ(test::invalid_samples(run), 0u);
        return test::mean_of(run.image);
    };
    const test::ImageMean near = mean(100.0f), far = mean(1e4f);
    EXPECT_NEAR(far.value / near.value, 1.0, 4.5 * std::hypot(near.error, far.error) / near.value + 0.01);
    test::figure("mean from 10,000 sizes away over that from 100", far.value / near.value);
}

/// Mean radiance of a map by sampling it.
double sampled_mean(const EnvironmentMap& map, std::uint32_t samples) {
    const test::MapParts parts(map);
    double sum = 0;
    for (std::uint32_t i = 0; i < samples; ++i) {
        const EnvironmentMap::Sample s = parts.sample(map, draw({8, i, 0}, 1, Stream::light));
        const float pdf = map.pdf(s, parts.choice);
        EXPECT_TRUE(is_finite(s.direction) && std::isfinite(pdf) && pdf > 0.0f) << pdf << s.direction;
        EXPECT_NEAR(s.direction.length(), 1.0f, 1e-5f);
        sum += double(map.radiance(s.direction).x) / double(pdf);
    }
    return sum / samples / (4 * M_PI);
}

/// 18 | Environment maps: poles, seams, black rows, hot texels, impossible ones
/// Others: densities at poles and at u = 0, rows of zeros, NaN texels (Mitsuba 3 aa8d03b31, badc04ab5; Cycles
/// 82ce8367f; pbrt 97b4ad76).
/// Here: integer tables, tents about texels, and texels that are no radiance count as black.
/// Holds: for maps of 1 x 1 to 64 x 32 texels that are black but for one texel (pole, seam, inside) of 1e-30 to
/// 1e30, or have NaN, negative and infinite texels, samples are finite with a density above 0, and their mean is
/// the map's within 1 % for a texel inside; a black map says so; directions on poles and seams have finite radiance
/// and density.
TEST(Lights, EnvironmentMapsOfEveryKind) {
    const LetFloatsBe hostile;  // numbers that are none come in
    test::Worst worst;
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 8}, {8, 1}, {64, 32}})
        for (const bool at_poles : {false, true})
            for (const auto& [x, y] : {std::pair{0, 0}, {width - 1, height - 1}, {width / 2, height / 2}})
                for (const float value : {1e-30f, 1.0f, 1e30f})
                    for (const float other : {0.0f, test::kNan, -1.0f, test::kInfinity}) {
                        TextureImage image;
                        image.width = width;
                        image.height = height;
                        image.floats.assign(static_cast<std::size_t>(3 * width * height), other);
                        for (int c = 0; c < 3; ++c)
                            image.floats[static_cast<std::size_t>(3 * (y * width + x) + c)] = value;
                        const bool inside = width == 64 && x == width / 2;
                        EnvironmentEmitter emitter;
                        emitter.rows_at_poles = at_poles;
                        const EnvironmentMap map(emitter, image);
                        ASSERT_FALSE(map.black());
                        // A row that is interpolated across the whole sphere has no simple mean: hold against
                        // quadrature.
                        const test::MapParts parts(map);
                        for (const Vec3& d : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, -0.0f, -1)}) {
                            const Rgb seen = map.radiance(d);
                            const float pdf = map.pdf(d, parts.choice);
                            ASSERT_TRUE(is_finite(seen) && std::isfinite(pdf) && pdf >= 0.0f);
                        }
                        const double mean = sampled_mean(map, inside ? 20000 : 200);
                        ASSERT_TRUE(std::isfinite(mean));
                        if (inside) worst.see(std::abs(mean / map.mean_radiance() - 1.0), x, y, value);
                    }
    EXPECT_LT(worst.value, 0.01) << worst.where;
    TextureImage black;
    black.width = black.height = 4;
    black.floats.assign(48, 0.0f);
    EXPECT_TRUE(EnvironmentMap({}, black).black());
    test::figure("largest relative error of the mean radiance by 20,000 samples", worst.value);
}

}  // namespace
}  // namespace treefarm
