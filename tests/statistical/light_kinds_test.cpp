// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <numeric>

#include "common/base/random.h"
#include "common/plan/resolve/resolve.h"
#include "tests/support/chi_square.h"
#include "tests/support/light_checks.h"
#include "tests/support/material_scenes.h"
#include "tests/support/test_scenes.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {
namespace {

using test::add_shape;
using test::expect_irradiance;
using test::expect_light_distribution;
using test::quad;

const Vec3 kUp(0, 0, 1);

Scene only_light(decltype(Shape::geometry) geometry) {
    Scene scene;
    add_shape(scene, std::move(geometry), kNone, Rgb(1.0f));
    return scene;
}

/// A scene lit by one emitter, with something small in it, so that it has a size.
Scene lit_by(decltype(Emitter::kind) kind) {
    Scene scene;
    add_shape(scene, quad({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}), kNone);
    scene.emitters.push_back({std::move(kind), {}});
    return scene;
}

/// A rectangle below z = h that faces down, whose texture is black for u below 0.5 (x below the middle).
Scene half_black_lamp(float h) {
    Scene scene;
    TextureImage image;
    image.width = 2;
    image.height = image.channels = 1;
    image.floats = {0.0f, 4.0f};
    scene.images.push_back(image);
    test::add_texture(scene, BitmapTexture{0, false, Wrap::repeat, Wrap::repeat, {}}, "");
    Mesh mesh = quad({-1, -1, h}, {0, 2, 0}, {2, 0, 0});
    mesh.uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    add_shape(scene, mesh, kNone, Rgb(0.5f));
    std::get<AreaEmitter>(scene.emitters[0].kind).radiance.texture = 0;
    return scene;
}

/// A map of zeros with some bright texels.
Scene environment(int width, int height, const std::vector<std::pair<int, int>>& bright, float background = 0.0f) {
    Scene scene = lit_by(EnvironmentEmitter{});
    TextureImage image;
    image.width = width;
    image.height = height;
    image.floats.assign(static_cast<std::size_t>(3 * width * height), background);
    for (const auto& [x, y] : bright)
        for (int c = 0; c < 3; ++c)
            image.floats[static_cast<std::size_t>(3 * (y * width + x) + c)] = 10.0f;
    scene.images.push_back(image);
    auto& map = std::get<EnvironmentEmitter>(scene.emitters[0].kind);
    map.image = 0;
    map.scale = 2.0f;
    // Turned, so that no axis of the map is one of the world.
    map.x_axis = normalize(Vec3(1, 2, 0.5f));
    map.z_axis = normalize(cross(map.x_axis, Vec3(0, 1, 0)));
    map.y_axis = cross(map.z_axis, map.x_axis);
    return scene;
}

TEST(LightDistribution, Ellipse) {
    expect_light_distribution(only_light(Disk{Vec3(0.3f, 0, 1.5f), Vec3(0, 2, 0.3f), Vec3(1, 0.4f, 0)}),
                              Vec3(0.3f, 0.1f, 0), "ellipse");
}

TEST(LightDistribution, CylinderFromOutside) {
    expect_light_distribution(
        only_light(Cylinder{Vec3(-1, 0.3f, 2), Vec3(1.5f, 0.3f, 1.5f), 0.7f, false, Vec3(0, 1, 0)}), Vec3(0.1f),
        "cylinder", 0.2f);
}

TEST(LightDistribution, CylinderFromInside) {
    Cylinder tube{Vec3(0, 0, -1), Vec3(0, 0, 2), 1.2f};
    tube.flip_normals = true;
    expect_light_distribution(only_light(tube), Vec3(0.5f, 0.3f, 0.2f), "tube");
}

TEST(LightDistribution, TexturedRectangle) {
    // Black halves are sampled, too, and count as no success: the density is compared where the lamp shines.
    expect_light_distribution(half_black_lamp(0.8f), Vec3(0.2f, 0.1f, 0), "half black");
}

TEST(LightDistribution, ImageWithOneBrightTexel) {
    const std::vector<std::pair<std::string, std::pair<int, int>>> texels = {
        {"amid", {5, 3}}, {"left of the seam", {15, 4}}, {"right of the seam", {0, 4}}};
    for (const auto& [what, texel] : texels)
        for (const float background : {0.0f, 0.2f})
            expect_light_distribution(environment(16, 8, {texel}, background), Vec3(0.0f), what);
}

TEST(LightDistribution, ImagesOfOddShapes) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 6}, {7, 1}, {2, 2}, {33, 5}})
        expect_light_distribution(environment(width, height, {{width - 1, height - 1}}, 1.0f), Vec3(0.0f),
                                  std::to_string(width) + " x " + std::to_string(height));
}

/// A panel of `side` by `side` small squares that shines downwards.
Mesh panel(int side, const Vec3& corner, float size) {
    Mesh mesh;
    const float step = size / static_cast<float>(side);
    for (int i = 0; i < side * side; ++i)
        test::append_quad(mesh, corner + Vec3(step * float(i % side), step * float(i / side), 0.0f), {0, step, 0},
                          {step, 0, 0});
    return mesh;
}

TEST(LightDistribution, PanelInPatches) {
    expect_light_distribution(only_light(panel(20, {-1.5f, -1, 0.7f}, 3.0f)), Vec3(0.0f), "panel");
    const TraceScene lights(only_light(panel(20, {-1.5f, -1, 0.7f}, 3.0f)), {});
    EXPECT_GT(lights.emitters().choice().node_count(), 8u) << "near patches are chosen more often than far ones";
}

/// Batches with gaps against samples drawn alone.
void expect_batches_as_alone(LightSelection how, int more_lamps) {
    Scene scene = environment(37, 11, {{5, 3}, {36, 0}, {0, 10}}, 0.3f);
    add_shape(scene, quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}), kNone, Rgb(3.0f));
    add_shape(scene, Sphere{Vec3(0, 0, 0.5f), 0.5f}, kNone, Rgb(1.0f, 2.0f, 3.0f));
    add_shape(scene, Sphere{Vec3(0, 0, 0), 4.0f, true}, kNone, Rgb(0.1f));
    scene.emitters.push_back({PointEmitter{Vec3(3, 0, 0), Rgb(1.5f)}, {}});
    scene.emitters.push_back({ConstantEmitter{Rgb(0.2f)}, {}});
    for (int i = 0; i < more_lamps; ++i)
        add_shape(scene, quad({float(i), 4, float(i % 7)}, {0, 0, 0.5f}, {0.5f, 0, 0}), kNone, Rgb(float(1 + i % 3)));
    Job job;
    job.integrator.light_selection = how;
    const TraceScene lights(scene, resolve(job, scene));
    const Emitters& emitters = lights.emitters();
    ASSERT_TRUE(emitters.draws_together());
    EXPECT_EQ(emitters.choice().node_count() > 0, more_lamps > 0 && LightChoice::by_point(how));
    LightProbabilities learned{};
    learned[0] = kLightProbabilityOne / 2;
    learned[1] = kLightProbabilityOne / 8;
    learned[4] = 3 * kLightProbabilityOne / 8;
    const Vec3 front = normalize(Vec3(1, 1, 1));
    int from_map = 0, on_lamp = 0, from_inside = 0, others = 0;
    LightBatch batch;
    for (std::uint32_t round = 0; round < 200; ++round) {
        const LightProbabilities* const probabilities = round % 2 == 0 ? nullptr : &learned;
        const auto random = [&](std::uint32_t lane) { return draw({6, round, lane}, 1, Stream::light); };
        const auto point = [&](std::uint32_t lane) { return Vec3(0.2f, 0.1f, 0.05f * static_cast<float>(lane) - 2); };
        const auto receiver = [&](std::uint32_t lane) {
            return LightReceiver(point(lane), probabilities, lane % 3 == 0 ? &front : nullptr);
        };
        const auto skipped = [&](std::uint32_t lane) { return (lane + round) % 5 == 0; };
        batch.clear();
        for (std::uint32_t lane = 0; lane < kDrawBatch; ++lane)
            if (!skipped(lane)) emitters.choose(batch, lane, receiver(lane), random(lane));
        emitters.draw(batch);
        for (std::uint32_t lane = 0; lane < kDrawBatch; ++lane) {
            if (skipped(lane)) continue;
            DirectSample a = emitters.sample_direct(batch, lane, random(lane));
            if (a.pdf > 0.0f) a.pdf = emitters.environment_pdf(batch, lane, a.pdf);
            const DirectSample b = emitters.sample_direct(receiver(lane), random(lane));
            ASSERT_EQ(a.pdf, b.pdf);
            ASSERT_EQ(a.from_environment, b.from_environment);
            ASSERT_EQ(a.delta, b.delta);
            ASSERT_EQ(a.cluster, b.cluster);
            ASSERT_EQ(a.cluster_probability, b.cluster_probability);
            if (!(a.pdf > 0.0f)) continue;
            ASSERT_EQ(a.wi, b.wi);
            ASSERT_EQ(a.distance, b.distance);
            ASSERT_EQ(a.radiance, b.radiance);
            ASSERT_EQ(a.on_light.p, b.on_light.p);
            ASSERT_EQ(a.on_light.ng, b.on_light.ng);
            const bool on_sphere = !a.from_environment && !a.delta && a.on_light.shape != 0;
            (a.from_environment ? from_map : !on_sphere ? others : a.on_light.shape == 1 ? on_lamp : from_inside) += 1;
            if (!a.from_environment) continue;
            const Rgb at_point = emitters.environment(batch, lane, a.wi), along = emitters.environment(b.wi);
            ASSERT_NEAR(at_point.x, along.x, 1e-3f * along.x + 0.05f) << "the sample's place is its direction's";
        }
    }
    EXPECT_GT(from_map, 1000);
    EXPECT_GT(on_lamp, 200);
    EXPECT_GT(from_inside, 200);
    EXPECT_GT(others, 200);
}

TEST(LightBatch, IsItsSamplesToTheBit) {
    expect_batches_as_alone(LightSelection::power, 0);
    expect_batches_as_alone(LightSelection::learned, 0);
    expect_batches_as_alone(LightSelection::learned, 30);
}

/// Integrals of light over directions agree however emitters are chosen, and densities are those of the samples.
TEST(LightChoice, ChangesNoIntegral) {
    for (const int lamps : {0, 30}) {
        Scene scene = environment(37, 11, {{5, 3}, {36, 0}}, 0.3f);
        add_shape(scene, quad({-1, -1, 3}, {0, 2, 0}, {2, 0, 0}), kNone, Rgb(1.0f));
        add_shape(scene, Sphere{Vec3(3, 0, 0), 0.7f, false}, kNone, Rgb(2.0f));
        add_shape(scene, Sphere{Vec3(0, 0, 0), 9.0f, true}, kNone, Rgb(0.01f));
        scene.emitters.push_back({ConstantEmitter{Rgb(0.2f)}, {}});
        scene.emitters.push_back({PointEmitter{Vec3(0, 0, 2), Rgb(1.0f)}, {}});
        scene.emitters.push_back({SpotEmitter{Vec3(0, 1, 2), Vec3(0, 0, -1), Rgb(6.0f), 0.8f, 0.4f}, {}});
        scene.emitters.push_back({DirectionalEmitter{Vec3(0, 0, -1), Rgb(0.7f)}, {}});
        for (int i = 0; i < lamps; ++i)
            add_shape(scene, quad({float(i % 5), 4, float(i % 7)}, {0, 0, 0.5f}, {0.5f, 0, 0}), kNone, Rgb(1.0f));
        if (lamps > 0) add_shape(scene, panel(8, {-3, -3, 4}, 5.0f), kNone, Rgb(0.3f));
        LightProbabilities learned{};
        learned[0] = kLightProbabilityOne / 4;
        learned[2] = kLightProbabilityOne / 2;
        learned[3] = kLightProbabilityOne / 4;
        const Vec3 p(0.1f, 0.2f, -0.3f), front = normalize(Vec3(0.3f, 0.2f, 1.0f));
        std::vector<std::pair<double, double>> results;
        for (const LightSelection how :
             {LightSelection::power, LightSelection::even, LightSelection::tree, LightSelection::learned}) {
            Job job;
            job.integrator.light_selection = how;
            const TraceScene lights(scene, resolve(job, scene));
            const Emitters& emitters = lights.emitters();
            const LightReceiver at(p, how == LightSelection::learned ? &learned : nullptr, &front);
            double sum = 0, sum2 = 0;
            constexpr std::uint32_t kSamples = 100000;
            for (std::uint32_t i = 0; i < kSamples; ++i) {
                const DirectSample s = emitters.sample_direct(at, draw({21, i, std::uint32_t(how)}, 1, Stream::light));
                if (!(s.pdf > 0.0f)) continue;
                const float cosine = std::max(dot(front, s.wi), 0.0f);
                const Rgb radiance = s.from_environment ? emitters.environment(s.wi) : s.radiance;
                const double light = double(average(radiance)) * double(cosine) / double(s.pdf);
                sum += light;
                sum2 += light * light;
                if (s.delta || i >= 20000) continue;
                const float pdf =
                    s.at_infinity() ? emitters.pdf_environment(at, s.wi) : emitters.pdf_direct(at, s.wi, s.on_light);
                if (s.at_infinity()) {
                    ASSERT_NEAR(s.pdf / pdf, 1.0f, 2e-3f);  // the map finds the texel again
                } else {
                    ASSERT_EQ(s.pdf, pdf) << "both sides agree to the bit";
                }
            }
            const double mean = sum / kSamples;
            results.emplace_back(mean, (sum2 / kSamples - mean * mean) / kSamples);
        }
        for (const auto& [mean, variance] : results)
            EXPECT_LT(std::abs(mean - results[0].first), 4 * std::sqrt(variance + results[0].second)) << lamps;
        EXPECT_LT(results[2].second, 0.7 * results[0].second) << "the hierarchy is worth its while";
    }
}

TEST(LightChoice, IsByPower) {
    Scene scene;
    add_shape(scene, quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}), kNone, Rgb(3.0f));
    add_shape(scene, Sphere{Vec3(0, 0, 0.5f), 0.5f}, kNone, Rgb(1.0f, 2.0f, 3.0f));
    const Vec3 point(3, 0, 0), spot(0, 3, 0);
    scene.emitters.push_back({PointEmitter{point, Rgb(1.5f)}, {}});
    scene.emitters.push_back({SpotEmitter{spot, Vec3(0, -1, 0), Rgb(6.0f), 0.8f, 0.4f}, {}});
    scene.emitters.push_back({DirectionalEmitter{Vec3(0, 0, -1), Rgb(0.7f)}, {}});
    scene.emitters.push_back({ConstantEmitter{Rgb(0.2f)}, {}});
    // W, of the channels' mean; what is infinitely far shines on the disk around the scene, whose radius is sqrt(3).
    const std::vector<double> power = {M_PI * 4 * 3,   M_PI * M_PI * 2,
                                       4 * M_PI * 1.5, 2 * M_PI * (1 - std::cos(0.6)) * 6,
                                       M_PI * 3 * 0.7, M_PI * M_PI * 3 * 0.2};
    const double total = std::accumulate(power.begin(), power.end(), 0.0);
    Job job;
    job.integrator.light_selection = LightSelection::power;
    const TraceScene lights(scene, resolve(job, scene));
    const Vec3 p(0.2f, 0.1f, -0.3f);
    constexpr std::uint32_t kSamples = 100000;
    std::vector<double> counts(power.size()), expected;
    for (const double watts : power)
        expected.push_back(watts / total * kSamples);
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const DirectSample s = lights.emitters().sample_direct(p, draw({5, i, 0}, 1, Stream::light));
        if (s.delta && s.at_infinity())
            ++counts[4];
        else if (s.delta)
            ++counts[dot(s.wi, normalize(point - p)) > 0.999f ? 2 : 3];
        else if (s.at_infinity())
            ++counts[5];
        else
            ++counts[s.on_light.shape];
    }
    EXPECT_GT(test::chi_square_test(counts, expected), 1e-4);
}

TEST(LightIrradiance, Disk) {
    for (const double scale : {1e-4, 1.0, 1e5})
        for (const double h : {0.1, 1.0, 20.0}) {
            const auto r = static_cast<float>(scale);
            const Scene scene =
                only_light(Disk{Vec3(0, 0, static_cast<float>(h * scale)), Vec3(0, r, 0), Vec3(r, 0, 0)});
            expect_irradiance(scene, Vec3(0.0f), kUp, M_PI / (1 + h * h),
                              "height " + std::to_string(h) + " scale " + std::to_string(scale));
        }
}

TEST(LightIrradiance, TubeAroundAPatch) {
    // What does not leave through the open end comes from the wall.
    for (const double scale : {1e-4, 1.0, 1e5}) {
        const auto s = static_cast<float>(scale);
        Cylinder tube{Vec3(0.0f), Vec3(0, 0, 1.5f * s), s};
        tube.flip_normals = true;
        expect_irradiance(only_light(tube), Vec3(0.0f), kUp, M_PI * (1 - 1 / (1 + 1.5 * 1.5)), std::to_string(scale));
    }
}

TEST(LightIrradiance, TexturesDimTheirEmitter) {
    // The lit half, at radiance 2, seen from below the middle: half of the whole rectangle's form factor.
    const double x = 1.0;
    const double corner = 2 * x / std::sqrt(1 + x * x) * std::atan(x / std::sqrt(1 + x * x)) / (2 * M_PI);
    expect_irradiance(half_black_lamp(1.0f), Vec3(0.0f), kUp, 2 * M_PI * 2 * corner, "half black");
}

TEST(LightIrradiance, MasksDimTheirEmitter) {
    Scene scene = only_light(Disk{Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(1, 0, 0)});
    scene.shapes[0].material = test::add_diffuse(scene, Rgb(0.5f));
    scene.materials[0].opacity = FloatInput(0.3f);
    expect_irradiance(scene, Vec3(0.0f), kUp, 0.3 * M_PI / 2, "opacity 0.3");
}

TEST(LightIrradiance, SpheresShineInwardsThroughTheHolesOfTheirMask) {
    // Light sampling finds the inside of the far half; that the near half hides some of it is the shadow ray's to say.
    Sphere sphere{Vec3(0, 0, 4), 1.0f, true};
    Scene scene = only_light(sphere);
    scene.shapes[0].material = test::add_diffuse(scene, Rgb(0.5f));
    scene.materials[0].opacity = FloatInput(0.3f);
    const test::Irradiance e = test::irradiance(scene, Vec3(0.0f), kUp, 400000);
    EXPECT_NEAR(e.light, 0.3 * M_PI / 16, 4.5 * e.light_error);
}

TEST(LightIrradiance, PointSpotAndParallelLight) {
    const Vec3 n = normalize(Vec3(0.5f, 0.2f, 1));
    for (const double scale : {1e-4, 1.0, 1e5}) {
        const auto s = static_cast<float>(scale);
        const Vec3 at = Vec3(1, 2, 3) * s;
        const double d2 = 14 * scale * scale, cosine = double(dot(n, normalize(at)));
        expect_irradiance(lit_by(PointEmitter{at, Rgb(5.0f)}), Vec3(0.0f), n, 5 * cosine / d2, "point");
        const Vec3 away = normalize(-at);
        const Vec3 side = normalize(cross(away, Vec3(0, 1, 0)));
        for (const double angle : {0.0, 0.29, 0.4, 0.49, 0.51, 2.0}) {
            const Vec3 axis = away * static_cast<float>(std::cos(angle)) + side * static_cast<float>(std::sin(angle));
            const double falloff = std::clamp((0.5 - angle) / 0.2, 0.0, 1.0);
            expect_irradiance(lit_by(SpotEmitter{at, axis, Rgb(5.0f), 0.5f, 0.3f}), Vec3(0.0f), n,
                              falloff * 5 * cosine / d2, "spot " + std::to_string(angle));
        }
        expect_irradiance(lit_by(DirectionalEmitter{away, Rgb(4.0f)}), Vec3(0.0f), n, 4 * cosine, "parallel");
    }
}

/// The picture of a spot on a plane across its axis: the unit square fills the square about the circle of the cone.
/// Texels are numbered; the spot shines down from z = 2, u along -x and v along y.
TEST(LightIrradiance, SpotsProjectTheirTexture) {
    constexpr int kSize = 4;
    const float cutoff = 0.6f, height = 2.0f;
    SpotEmitter spot{Vec3(1, -2, height), Vec3(0, 0, -1), Rgb(5.0f), cutoff, cutoff, 0, Vec3(-1, 0, 0), Vec3(0, 1, 0)};
    Scene scene = lit_by(spot);
    TextureImage image;
    image.width = image.height = kSize;
    image.channels = 1;
    for (int i = 0; i < kSize * kSize; ++i)
        image.floats.push_back(1.0f + float(i));
    scene.images.push_back(image);
    test::add_texture(scene, BitmapTexture{0, false, Wrap::repeat, Wrap::repeat, {}}, "");
    const float half = height * std::tan(cutoff);
    for (int row = 0; row < kSize; ++row)
        for (int column = 0; column < kSize; ++column) {
            const float u = (float(column) + 0.4f) / kSize, v = (float(row) + 0.7f) / kSize;
            const Vec3 p(1 - half * (2 * u - 1), -2 + half * (2 * v - 1), 0.0f);
            const Vec3 away = p - spot.position;
            const double distance = double(away.length()), cosine = double(height) / distance;
            const bool lit = std::acos(cosine) < double(cutoff);
            const double texel = 1.0 + row * kSize + column;
            expect_irradiance(scene, p, kUp, lit ? 5.0 * texel * cosine / (distance * distance) : 0.0,
                              "texel " + std::to_string(column) + ", " + std::to_string(row));
        }
}

TEST(LightIrradiance, ConstantEnvironmentAndConstantImage) {
    expect_irradiance(lit_by(ConstantEmitter{Rgb(1.5f)}), Vec3(0.0f), kUp, 1.5 * M_PI, "constant");
    for (const auto& [width, height] : {std::pair{1, 1}, {16, 8}, {512, 256}})
        expect_irradiance(environment(width, height, {}, 0.75f), Vec3(0.0f), kUp, 1.5 * M_PI,
                          "constant image of " + std::to_string(width));
}

TEST(LightIrradiance, SeveralEmittersAddUp) {
    Scene scene = environment(16, 8, {}, 0.5f);
    scene.emitters.push_back({ConstantEmitter{Rgb(0.25f)}, {}});
    scene.emitters.push_back({PointEmitter{Vec3(0, 0, 2), Rgb(3.0f)}, {}});
    scene.emitters.push_back({DirectionalEmitter{Vec3(0, 0, -1), Rgb(0.5f)}, {}});
    expect_irradiance(scene, Vec3(0.0f), kUp, 1.25 * M_PI + 0.75 + 0.5, "several");
}

}  // namespace
}  // namespace treefarm
