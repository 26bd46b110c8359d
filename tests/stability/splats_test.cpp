// SPDX-License-Identifier: Apache-2.0
// What light paths bring to pixels: on edges, by lamps of any power, and near the lens of a large scene.
#include <numeric>

#include "tests/support/both_ends.h"
#include "tests/support/scaled_scene.h"
#include "tests/support/test_scenes.h"
#include "worker/camera/camera_importance.h"

namespace treefarm {
namespace {

/// 22 | Splats on the edges of pixels, the film and its window
/// Others: a splat at a whole coordinate went to two pixels or to none (Mitsuba 3 2d8976266).
/// Here: a filter holds its left edge and not its right one; one pixel is drawn by the filters there, and weighs their
/// sum.
/// Holds: at whole and half coordinates, 1e-12 and a step of float beside them, on the border of a film and a window
/// and beyond, for boxes, a tent and a Gaussian: of 256 numbers each pixel gets as many as its filter says within one,
/// none without it; the weight is the filters' sum within 1e-6. Boxes of a pixel give a place to exactly one, and so
/// do a panorama's on its seam and 2^-21 off its poles. What is nowhere goes nowhere.
TEST(Splats, OnEdges) {
    const LetFloatsBe hostile;  // numbers that are none come in
    std::vector<double> positions = {-1e300, 1e300, test::kInfinity, -test::kInfinity, test::kNan};
    for (int twice = -6; twice <= 20; ++twice)
        for (const double beside : {0.0, -1e-12, 1e-12, -0x1p-21, 0x1p-21})
            positions.push_back(0.5 * twice + beside);
    test::Worst worst;
    for (const auto& [kind, radius] : {std::pair(PixelFilter::box, 0.5f),
                                       {PixelFilter::box, 0.7f},
                                       {PixelFilter::tent, 1.0f},
                                       {PixelFilter::gaussian, 2.0f}})
        for (const int first : {0, 3}) {
            Film film;
            film.width = first == 0 ? 7 : 2;
            film.height = 1;
            film.filter = kind;
            film.filter_radius = radius;
            if (first > 0) film.crop = {.x = first, .y = 0, .whole_width = 7, .whole_height = 1};
            const PixelPicker picker(film, false);
            const FilterSampler filter(film);
            const double row = double(filter.value(0.0f)), per_window = 7.0 / film.width;
            for (const double x : positions) {
                std::vector<double> shares;
                for (int i = 0; i < film.width; ++i)
                    shares.push_back(double(filter.value(static_cast<float>(x - (first + i + 0.5)))));
                const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
                std::vector<int> picked(shares.size());
                for (std::uint32_t k = 0; k <= 256; ++k) {
                    const std::uint32_t number = k == 256 ? 0xffffffffu : k << 24;
                    const PixelPick pick = picker.pick(x, 0.5, {number, number, 0, 0});
                    ASSERT_EQ(pick.found, sum > 0.0) << x << " " << radius;
                    if (!pick.found) continue;
                    ASSERT_TRUE(picker.reaches(x - 1e-9, 0.5) || picker.reaches(x + 1e-9, 0.5)) << x << " " << radius;
                    ASSERT_LT(pick.pixel, picked.size()) << x;
                    if (k < 256) ++picked[pick.pixel];
                    ASSERT_GT(shares[pick.pixel], 0.0) << x << " " << radius;
                    worst.see(std::abs(pick.weight / (sum * row * per_window) - 1.0), x, radius);
                }
                for (std::size_t i = 0; i < shares.size() && sum > 0.0; ++i)
                    ASSERT_NEAR(picked[i], 256 * shares[i] / sum, 1.0) << x << " pixel " << i << " radius " << radius;
                if (radius == 0.5f && x >= first && x < first + film.width - 1e-7) {
                    ASSERT_EQ(sum, 1.0) << x << ": not one pixel";
                }
            }
        }
    Film around;
    around.width = 8;
    around.height = 4;
    for (const double x : {0.0, 1e-12, 0.5, 4.0, 7.5, 8.0 - 0x1p-21, 8.0})
        for (const double y : {0x1p-21, 0.5, 2.0, 4.0 - 0x1p-21}) {
            const PixelPick pick = PixelPicker(around, true).pick(x, y, {0x80000000u, 0x80000000u, 0, 0});
            ASSERT_TRUE(pick.found) << x << " " << y;
            ASSERT_EQ(pick.weight, 1.0) << x << " " << y;
            ASSERT_EQ(pick.pixel, static_cast<std::uint32_t>(y) * 8 + static_cast<std::uint32_t>(x) % 8) << x << y;
        }
    EXPECT_LT(worst.value, 1e-6) << worst.where;
    test::figure("largest relative error of a weight", worst.value);
}

/// ours | Lamps of any power
/// Others: NaN splats spread over the image (pbrt-v4 #134).
/// Here: the quantum of splats follows the power of the scene; the film's door counts what is no radiance.
/// Holds: lamps 2^66 times as bright and as faint give images of that many times to the bit, by paths, from the lamps
/// and from both ends; next to a lamp of 1e20 in a closed box the mean is what it is without it within 4.5 standard
/// errors; a lamp of 3e38 is counted out, and no pixel is NaN or infinite.
TEST(Splats, OfLampsOfAnyPower) {
    const LetFloatsBe hostile;  // radiance overflows
    Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    test::set_film(scene, 12, 12);
    test::add_shape(scene, Sphere{{0.2f, 0.9f, 0.2f}, 0.05f}, kNone, Rgb(3.0f));
    const auto shining = [&](float factor) {
        Scene other = scene;
        for (Emitter& emitter : other.emitters)
            std::get<AreaEmitter>(emitter.kind).radiance.value *= factor;
        return other;
    };
    for (const char* const type : test::kFromAnyEnd) {
        const test::LocalRender here = test::render_by(type, scene, 28, 5);
        for (const float factor : {0x1p66f, 0x1p-66f})
            test::expect_same_bits(here, test::render_by(type, shining(factor), 28, 5), double(factor), type);
    }
    for (const char* const type : test::kFromLamps) {
        const test::LocalRender run = test::render_by(type, test::scaled(shining(1e37f), 100.0f), 8, 5);
        EXPECT_GT(run.splat_caps.rejected, 0u) << type << ": weights of its light paths are infinite";
        for (std::size_t i = 0; i < run.image.mean.size(); ++i)
            ASSERT_TRUE(is_finite(Rgb(run.image.mean[i] * 1e-30))) << type;
    }
    const test::ImageMean alone = test::mean_of(test::render_by("path", scene, 124, 5, test::hide_emitters).image);
    test::add_shape(scene, Sphere{{5, 0, 0}, 0.1f}, kNone, Rgb(1e20f));
    test::add_shape(scene, test::box({4, -1, -1}, {6, 1, 1}, true), kNone);
    const test::ImageMean beside =
        test::mean_of(test::render_by("bidirectional", scene, 124, 5, test::hide_emitters).image);
    const double error = std::hypot(alone.error, beside.error);
    EXPECT_NEAR(alone.value, beside.value, 4.5 * error);
    EXPECT_LT(error, 0.05 * alone.value);
    test::figure("mean beside a hidden lamp of 1e20 over that without it", beside.value / alone.value);
}

/// ours | A lamp over a large ground
/// Others: what light paths bring depended on how far the lens is from the lamp (LuxCore #678).
/// Here: the quantum of splats also goes by how near to the lens lamps are, not by the scene's middle alone.
/// Holds: over grounds of about the distance of lens and lamp to 10,000 times as much nothing is capped, and the means
/// agree with path tracing's within 4.5 standard errors.
TEST(Splats, OfALampOverALargeGround) {
    test::Worst worst;
    for (const float half : {2.0f, 200.0f, 2e4f}) {
        Scene scene;
        const std::int32_t grey = test::add_diffuse(scene, Rgb(0.5f));
        test::add_shape(scene, test::quad({-half, 0, -half}, {0, 0, 2 * half}, {2 * half, 0, 0}), grey);
        test::add_shape(scene, test::quad({-0.3f, 2, -0.3f}, {0.6f, 0, 0}, {0, 0, 0.6f}), kNone, Rgb(10.0f));
        scene.camera = test::look_at({0, 1, -3}, {0, 0.3f, 0}, {0, 1, 0}, 0.3f);
        test::set_film(scene, 12, 12);
        worst.see(test::expect_mean_of_paths(scene, 3, 120, std::to_string(half)), half);
    }
    test::figure("difference of means, in standard errors, at most", worst.value);
}

}  // namespace
}  // namespace treefarm
