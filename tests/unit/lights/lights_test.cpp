// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "tests/support/test_scenes.h"
#include "worker/lights/emitters.h"

namespace treefarm {
namespace {

using test::add_shape;
using test::quad;

/// Geometry and emitters of a scene, kept together.
struct Lights {
    explicit Lights(const Scene& scene)
        : geometry(scene.shapes, "avx2"), emitters(scene.emitters, geometry, scene.bounds()) {}
    EmbreeScene geometry;
    Emitters emitters;
};

Draw random_draw(std::uint32_t i) {
    return draw({5, i, 0}, 1, Stream::light);
}

TEST(DiscreteTable, PicksWithTheProbabilitiesItStates) {
    const std::vector<double> weights = {0.0, 1.0, 0.0, 3.0, 4.0, 0.0};
    const DiscreteTable table(weights);
    EXPECT_EQ(table.probability(0), 0.0f);
    EXPECT_EQ(table.probability(1), 0.125f);
    EXPECT_EQ(table.probability(3), 0.375f);
    EXPECT_EQ(table.probability(4), 0.5f);
    EXPECT_EQ(table.pick(0), 1u);
    EXPECT_EQ(table.pick(0x1fffffffu), 1u);
    EXPECT_EQ(table.pick(0x20000000u), 3u);
    EXPECT_EQ(table.pick(0x7fffffffu), 3u);
    EXPECT_EQ(table.pick(0x80000000u), 4u);
    EXPECT_EQ(table.pick(0xffffffffu), 4u);
}

TEST(DiscreteTable, ManyEntriesSumToOne) {
    std::mt19937 random(1);
    std::vector<double> weights(10007);
    for (double& w : weights)
        w = random() % 3 == 0 ? 0.0 : std::uniform_real_distribution<double>()(random);
    const DiscreteTable table(weights);
    double sum = 0;
    for (std::uint32_t i = 0; i < weights.size(); ++i) {
        sum += table.probability(i);
        if (weights[i] == 0.0) {
            ASSERT_EQ(table.probability(i), 0.0f);
        }
    }
    EXPECT_NEAR(sum, 1.0, 1e-6);
    for (int i = 0; i < 100000; ++i)
        ASSERT_GT(table.probability(table.pick(static_cast<std::uint32_t>(random()))), 0.0f);
    EXPECT_GT(table.probability(table.pick(0xffffffffu)), 0.0f);
}

TEST(DiscreteTable, NothingToPick) {
    EXPECT_TRUE(DiscreteTable().empty());
    EXPECT_TRUE(DiscreteTable(std::vector<double>{0.0, 0.0}).empty());
}

TEST(Emitters, WithoutLightThereIsNoSample) {
    Scene scene;
    add_shape(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), kNone);
    const Lights lights(scene);
    EXPECT_FALSE(lights.emitters.can_sample());
    EXPECT_EQ(lights.emitters.sample_direct(Vec3(0, 0, 1), random_draw(0)).pdf, 0.0f);
    EXPECT_EQ(lights.emitters.pdf_environment(Vec3(0, 0, 1), Vec3(0, 0, 1)), 0.0f);
}

TEST(Emitters, AreChosenByPower) {
    Scene scene;
    add_shape(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), kNone, Rgb(3.0f));
    add_shape(scene, quad({0, 0, 5}, {0.5f, 0, 0}, {0, 0.5f, 0}), kNone, Rgb(4.0f));
    const Lights lights(scene);
    int first = 0;
    for (std::uint32_t i = 0; i < 40000; ++i)
        first += lights.emitters.sample_direct(Vec3(0, 0, 2), random_draw(i)).on_light.shape == 0;
    EXPECT_NEAR(first / 40000.0, 0.75, 0.01);
}

TEST(Emitters, ShineFromTheFrontOnly) {
    Scene scene;
    add_shape(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), kNone, Rgb(3.0f));
    const Lights lights(scene);
    for (std::uint32_t i = 0; i < 100; ++i) {
        EXPECT_EQ(lights.emitters.sample_direct(Vec3(0.5f, 0.5f, 1), random_draw(i)).radiance, Rgb(3.0f));
        const DirectSample back = lights.emitters.sample_direct(Vec3(0.5f, 0.5f, -1), random_draw(i));
        EXPECT_TRUE(is_black(back.radiance));
        EXPECT_GT(back.pdf, 0.0f);
    }
    Hit hit;
    ASSERT_TRUE(lights.geometry.intersect({Vec3(0.4f, 0.5f, 1), Vec3(0, 0, -1)}, hit));
    EXPECT_EQ(lights.emitters.emitted(hit, Vec3(0, 0, 1)), Rgb(3.0f));
    EXPECT_TRUE(is_black(lights.emitters.emitted(hit, Vec3(0, 0, -1))));
    EXPECT_TRUE(is_black(lights.emitters.emitted(hit, Vec3(1, 0, 0)))) << "nor along the surface";
}

TEST(Emitters, FlippedSphereShinesInside) {
    Scene scene;
    add_shape(scene, Sphere{Vec3(0.0f), 1.0f, true}, kNone, Rgb(2.0f));
    const Lights lights(scene);
    for (std::uint32_t i = 0; i < 100; ++i) {
        EXPECT_EQ(lights.emitters.sample_direct(Vec3(0.2f, 0.1f, 0), random_draw(i)).radiance, Rgb(2.0f));
        EXPECT_TRUE(is_black(lights.emitters.sample_direct(Vec3(2, 0, 0), random_draw(i)).radiance));
    }
}

Scene every_kind_of_light() {
    Scene scene;
    add_shape(scene, quad({-1, -1, 3}, {0, 2, 0}, {2, 0, 0}), kNone, Rgb(1.0f));
    add_shape(scene, Sphere{Vec3(3, 0, 0), 0.7f, false}, kNone, Rgb(2.0f));
    add_shape(scene, test::sphere_mesh(Vec3(-3, 1, 0), 0.8f, 2, true), kNone, Rgb(1.5f));
    scene.emitters.push_back({ConstantEmitter{Rgb(0.2f)}, {}});
    return scene;
}

TEST(Emitters, DensityOfAHitIsThatOfTheSample) {
    const Lights lights(every_kind_of_light());
    const Vec3 p(0.1f, 0.2f, -0.3f);
    int compared = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const DirectSample s = lights.emitters.sample_direct(p, random_draw(i));
        ASSERT_GT(s.pdf, 0.0f);
        ASSERT_NEAR(s.wi.length(), 1.0f, 1e-5f);
        if (s.at_infinity()) {
            // Of an image, a texel's gradient times the rounding of the direction.
            ASSERT_NEAR(s.pdf, lights.emitters.pdf_environment(p, s.wi), 1e-3f * s.pdf);
            continue;
        }
        ASSERT_EQ(s.pdf, lights.emitters.pdf_direct(p, s.wi, s.on_light));
        Hit hit;
        if (is_black(s.radiance) || !lights.geometry.intersect({p, s.wi}, hit) || hit.shape != s.on_light.shape)
            continue;
        if (hit.primitive != s.on_light.primitive || dot(hit.ng, -s.wi) < 0.05f) continue;
        ASSERT_NEAR(lights.emitters.pdf_direct(p, s.wi, hit) / s.pdf, 1.0f, 1e-3f);
        ASSERT_NEAR((hit.p - p).length(), s.distance, 1e-3f * s.distance);
        ++compared;
    }
    EXPECT_GT(compared, 3000);
}

TEST(Emitters, ASurfaceThatReflectsOnlyGetsTheSamplesThatItSees) {
    Scene scene = every_kind_of_light();
    add_shape(scene, quad({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}), kNone, Rgb(1.0f));
    const Lights lights(scene);
    const Vec3 p(0.1f, 0.2f, -0.3f), front = normalize(Vec3(0.4f, -0.2f, 0.9f));
    int kept = 0, dropped = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const DirectSample all = lights.emitters.sample_direct(p, random_draw(i));
        const DirectSample seen = lights.emitters.sample_direct(p, random_draw(i), nullptr, &front);
        const float cosine = dot(front, all.wi);
        const bool useful = cosine > 0.0f && !all.black();
        // Where it grazes, rounding decides.
        if (std::abs(cosine) < 1e-5f) continue;
        if (!useful) {
            EXPECT_TRUE(seen.pdf == 0.0f || seen.black());
            ++dropped;
            continue;
        }
        ASSERT_EQ(seen.pdf, all.pdf);
        ASSERT_EQ(seen.wi, all.wi);
        ASSERT_EQ(seen.radiance, all.radiance);
        ASSERT_EQ(seen.on_light.p, all.on_light.p);
        ASSERT_EQ(seen.on_light.primitive, all.on_light.primitive);
        ++kept;
    }
    EXPECT_GT(kept, 5000);
    EXPECT_GT(dropped, 5000);
}

TEST(Emitters, PointsOfFlatTrianglesAreThoseOfTheGeometry) {
    const Lights lights(every_kind_of_light());
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const DirectSample sample = lights.emitters.sample_direct(Vec3(0.1f, 0.2f, -0.3f), random_draw(i));
        const Hit& hit = sample.on_light;
        if (sample.at_infinity() || lights.geometry.triangle_count(hit.shape) == 0) continue;
        const Hit same = lights.geometry.triangle_point(hit.shape, hit.primitive, hit.b1, hit.b2);
        ASSERT_EQ(hit.p, same.p);
        ASSERT_EQ(hit.ng, same.ng);
        ASSERT_EQ(hit.ns, same.ns);
        ASSERT_EQ(hit.error, same.error);
    }
}

TEST(Emitters, NonEmittersHaveNoDensity) {
    Scene scene = every_kind_of_light();
    const auto dark = static_cast<std::uint32_t>(add_shape(scene, quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), kNone));
    const Lights lights(scene);
    Hit hit;
    hit.shape = dark;
    EXPECT_EQ(lights.emitters.pdf_direct(Vec3(0, 0, 1), Vec3(0, 0, -1), hit), 0.0f);
    EXPECT_TRUE(is_black(lights.emitters.emitted(hit, Vec3(0, 0, 1))));
}

TEST(Emitters, TinyAndDistantSpheresKeepTheirSolidAngle) {
    for (const double radius : {1e-6, 1e-3, 1.0, 1e3})
        for (const double distance : {1e-3, 1.0, 1e3, 1e6}) {
            if (radius >= 0.9 * distance) continue;
            Scene scene;
            add_shape(scene, Sphere{Vec3(0, 0, float(distance)), float(radius), false}, kNone, Rgb(1.0f));
            const Lights lights(scene);
            const double s2 = (radius / distance) * (radius / distance);
            const double solid_angle = 2 * M_PI * s2 / (1 + std::sqrt(1 - s2));
            for (std::uint32_t i = 0; i < 50; ++i) {
                const DirectSample s = lights.emitters.sample_direct(Vec3(0.0f), random_draw(i));
                ASSERT_NEAR(s.pdf * solid_angle, 1.0, 1e-4) << radius << " " << distance;
                ASSERT_NEAR(s.wi.length(), 1.0f, 1e-6f);
                const Imath::V3d on(s.on_light.p);
                ASSERT_NEAR((on - Imath::V3d(0, 0, distance)).length(), radius, 1e-6 * (radius + distance));
                ASSERT_LE(s.distance, distance * (1 + 1e-6));
            }
        }
}

TEST(Emitters, TinyAndDistantTrianglesKeepTheirSolidAngle) {
    for (const double size : {1e-6, 1e-3, 1.0, 1e3})
        for (const double distance : {1e-3, 1.0, 1e3, 1e6}) {
            if (size > 0.01 * distance) continue;
            Scene scene;
            const auto e = static_cast<float>(size), d = static_cast<float>(distance);
            // Far from the origin the corners themselves would be rounded: the light stays there, the point moves.
            add_shape(scene, quad({-0.5f * e, -0.5f * e, 0}, {e, 0, 0}, {0, e, 0}), kNone, Rgb(1.0f));
            const Lights lights(scene);
            for (std::uint32_t i = 0; i < 50; ++i) {
                const DirectSample s = lights.emitters.sample_direct(Vec3(0, 0, d), random_draw(i));
                ASSERT_NEAR(s.pdf * size * size / (distance * distance), 1.0, 1e-3) << size << " " << distance;
                ASSERT_EQ(s.radiance, Rgb(1.0f));
            }
        }
}

TEST(Emitters, PointsOnTheLightGiveNoNaN) {
    const Lights lights(every_kind_of_light());
    for (const Vec3& p : {Vec3(0, 0, 3), Vec3(-1, -1, 3), Vec3(3.7f, 0, 0), Vec3(3, 0, 0), Vec3(-3, 1, 0)})
        for (std::uint32_t i = 0; i < 1000; ++i) {
            const DirectSample s = lights.emitters.sample_direct(p, random_draw(i));
            ASSERT_TRUE(std::isfinite(s.pdf) && is_finite(s.wi) && s.pdf >= 0.0f);
        }
}

TEST(Emitters, ZeroAreaTrianglesAreNeverPicked) {
    Scene scene;
    Mesh mesh = quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    mesh.indices.insert(mesh.indices.begin(), {0, 0, 1});
    add_shape(scene, mesh, kNone, Rgb(1.0f));
    const Lights lights(scene);
    for (std::uint32_t i = 0; i < 1000; ++i)
        ASSERT_NE(lights.emitters.sample_direct(Vec3(0, 0, 1), random_draw(i)).on_light.primitive, 0u);
}

}  // namespace
}  // namespace treefarm
