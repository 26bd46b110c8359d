#include <gtest/gtest.h>

#include "tests/support/test_scenes.h"
#include "worker/integrator/camera_rays.h"

namespace treefarm {
namespace {

constexpr Draw kCentre = {0x80000000u, 0x80000000u, 0, 0};

Film film(int width, int height) {
    Film f;
    f.width = width;
    f.height = height;
    return f;
}

TEST(Camera, CentreOfTheFilmLooksAtTheTarget) {
    const CameraRays camera(test::look_at(Vec3(1, 2, 3), Vec3(4, 2, 7), Vec3(0, 1, 0), 0.5f), film(3, 3));
    const Ray ray = camera.generate(1, 1, kCentre);
    EXPECT_EQ(ray.origin, Vec3(1, 2, 3));
    EXPECT_LT((ray.direction - normalize(Vec3(3, 0, 4))).length(), 1e-6f);
    EXPECT_TRUE(std::isinf(ray.length));
}

TEST(Camera, RowsRunDownAndColumnsToTheRight) {
    const CameraRays camera(test::look_at(Vec3(0.0f), Vec3(0, 0, -1), Vec3(0, 1, 0), 1.0f), film(4, 4));
    EXPECT_LT(camera.generate(0, 2, kCentre).direction.x, camera.generate(3, 2, kCentre).direction.x);
    EXPECT_GT(camera.generate(2, 0, kCentre).direction.y, camera.generate(2, 3, kCentre).direction.y);
    const Vec3 first = camera.generate(0, 0, kCentre).direction;
    EXPECT_LT((first - normalize(Vec3(-0.75f, 0.75f, -1))).length(), 1e-6f);
}

TEST(Camera, BoxFilterStaysInThePixel) {
    const CameraRays camera(test::look_at(Vec3(0.0f), Vec3(0, 0, -1), Vec3(0, 1, 0), 1.0f), film(2, 2));
    for (const std::uint32_t r : {0u, 1u, 0x7fffffffu, 0xffffffffu}) {
        const Vec3 d = camera.generate(0, 0, {r, r, 0, 0}).direction;
        EXPECT_GE(d.x / -d.z, -1.000001f);
        EXPECT_LE(d.x / -d.z, 0.000001f);
        EXPECT_GE(d.y / -d.z, -0.000001f);
        EXPECT_LE(d.y / -d.z, 1.000001f);
    }
}

TEST(Camera, LongLensesKeepPixelsApart) {
    // 1e4 scene sizes away with a field of view of 1e-4: pixels are 1e-7 apart in direction, about one float step.
    Film f = film(512, 512);
    f.filter = PixelFilter::box;
    const Camera lens = test::look_at(Vec3(0, 0, 1e4f), Vec3(0.0f), Vec3(0, 1, 0), 1e-4f);
    const CameraRays camera(lens, f);
    double worst = 0;
    for (int x = 0; x < 512; ++x) {
        const Vec3 d = camera.generate(x, 256, kCentre).direction;
        const double expected = ((x + 0.5) / 512 - 0.5) * 2e-4;
        worst = std::max(worst, std::abs(double(d.x) / -double(d.z) - expected));
    }
    EXPECT_LT(worst, 0.1 * 2e-4 / 512) << "less than a tenth of a pixel";
}

TEST(Camera, ExtremeRandomNumbersStayWithinTheFilter) {
    for (const PixelFilter kind : {PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian}) {
        Film f;
        f.filter = kind;
        f.filter_radius = kind == PixelFilter::gaussian ? 2.0f : 1.0f;
        const FilterSampler sampler(f);
        for (const std::uint32_t r : {0u, 1u, 0x7fffffffu, 0x80000000u, 0x80000001u, 0xfffffffeu, 0xffffffffu}) {
            EXPECT_TRUE(std::isfinite(sampler.sample(r)));
            EXPECT_LE(std::abs(sampler.sample(r)), f.filter_radius);
        }
    }
}

}  // namespace
}  // namespace treefarm
