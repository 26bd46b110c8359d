// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/test_scenes.h"
#include "worker/camera/camera_rays.h"

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

/// Focused on the plane z = -focus.
Camera thin_lens(float focus, float radius) {
    Camera camera = test::look_at(Vec3(0.0f), Vec3(0, 0, -1), Vec3(0, 1, 0), 0.5f);
    camera.corner *= focus;
    camera.across *= focus;
    camera.down *= focus;
    camera.lens_u = Vec3(radius, 0, 0);
    camera.lens_v = Vec3(0, radius, 0);
    return camera;
}

Vec3 at_depth(const Ray& ray, float depth) {
    return ray.origin + ray.direction * ((depth + ray.origin.z) / -ray.direction.z);
}

TEST(Camera, LensIsSharpInItsPlaneOfFocus) {
    const CameraRays lens(thin_lens(4.0f, 0.3f), film(8, 8));
    const CameraRays pinhole(test::look_at(Vec3(0.0f), Vec3(0, 0, -1), Vec3(0, 1, 0), 0.5f), film(8, 8));
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const Draw r = draw({1, i, 0}, 0, Stream::camera);
        const Vec3 sharp = at_depth(pinhole.generate(2, 5, r), 4.0f), seen = at_depth(lens.generate(2, 5, r), 4.0f);
        ASSERT_LT((sharp - seen).length(), 2e-6f);
        ASSERT_NEAR(lens.generate(2, 5, r).direction.length(), 1.0f, 1e-6f);
    }
}

TEST(Camera, LensBlursOtherDepthsByTheCircleOfConfusion) {
    // By similar triangles: lens radius times |depth - focus| / focus, filled uniformly.
    const CameraRays lens(thin_lens(4.0f, 0.3f), film(8, 8));
    for (const float depth : {1.0f, 3.0f, 6.0f, 20.0f}) {
        const float radius = 0.3f * std::abs(depth - 4.0f) / 4.0f;
        const Ray middle = lens.generate(2, 5, {kCentre[0], kCentre[1], 0x80000000u, 0x80000000u});
        ASSERT_EQ(middle.origin, Vec3(0.0f));
        float farthest = 0;
        double sum2 = 0;
        Vec3 mean(0.0f);
        constexpr int kRays = 20000;
        for (std::uint32_t i = 0; i < kRays; ++i) {
            const Draw r = draw({2, i, 0}, 0, Stream::camera);
            const Vec3 off =
                at_depth(lens.generate(2, 5, {kCentre[0], kCentre[1], r[2], r[3]}), depth) - at_depth(middle, depth);
            farthest = std::max(farthest, off.length());
            sum2 += double(dot(off, off));
            mean += off * (1.0f / kRays);
        }
        EXPECT_LE(farthest, radius * 1.0001f);
        EXPECT_GE(farthest, radius * 0.99f);
        EXPECT_NEAR(sum2 / kRays, 0.5 * double(radius) * double(radius), 0.02 * double(radius) * double(radius));
        EXPECT_LT(mean.length(), 0.03f * radius);
    }
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

TEST(Camera, OrthographicRaysAreParallel) {
    Camera ortho;
    ortho.origin = Vec3(0, 0, 4);
    ortho.corner = Vec3(-2, 1, 0);
    ortho.across = Vec3(4, 0, 0);
    ortho.down = Vec3(0, -2, 0);
    ortho.parallel = Vec3(0, 0, -1);
    const CameraRays camera(ortho, film(4, 2));
    for (int x = 0; x < 4; ++x)
        for (int y = 0; y < 2; ++y) {
            const Ray ray = camera.generate(x, y, kCentre);
            EXPECT_EQ(ray.direction, Vec3(0, 0, -1));
            EXPECT_LT((ray.origin - Vec3(-1.5f + float(x), 0.5f - float(y), 4)).length(), 1e-6f);
            const PathKey path{1, 2, 3};
            const Ray one = camera.generate(x, y, path), other = camera.generate(x, y, draw(path, 0, Stream::camera));
            EXPECT_EQ(one.origin, other.origin);
            EXPECT_EQ(one.direction, other.direction);
        }
}

/// Pixels of a panorama see solid angles by their latitude; all of them together see everything once.
TEST(Camera, APanoramaSeesEveryDirection) {
    Camera all;
    all.origin = Vec3(3, 2, 1);
    all.across = Vec3(1, 0, 0);
    all.down = Vec3(0, 1, 0);
    all.corner = Vec3(0, 0, 1);
    all.panoramic = true;
    const int width = 64, height = 32;
    const CameraRays camera(all, film(width, height));
    const auto degrees = [](const Vec3& a, const Vec3& b) { return std::acos(std::min(1.0f, a.dot(b))) * 180 / M_PI; };
    for (int x = 0; x < width; ++x)
        for (int y = 0; y < height; ++y) {
            const Ray ray = camera.generate(x, y, kCentre);
            EXPECT_EQ(ray.origin, all.origin);
            EXPECT_NEAR(ray.direction.length(), 1.0f, 1e-6f);
            EXPECT_NEAR(std::acos(ray.direction.y), M_PI * (y + 0.5) / height, 1e-5);
            const Ray beside = camera.generate((x + 1) % width, y, kCentre);
            EXPECT_LE(degrees(ray.direction, beside.direction), 360.0 / width + 1e-3);
            const PathKey path{1, 2, 3};
            EXPECT_EQ(camera.generate(x, y, path).direction,
                      camera.generate(x, y, draw(path, 0, Stream::camera)).direction);
        }
}

TEST(Camera, PixelsOfACropWindowAreThoseOfTheWholeFilm) {
    const Film whole = film(40, 30);
    Film part = film(16, 10);
    part.crop = {8, 5, 40, 30};
    const Camera view = test::look_at(Vec3(1, 2, 3), Vec3(4, 2, 7), Vec3(0, 1, 0), 0.5f);
    const CameraRays all(view, whole), some(view, part);
    for (int x = 0; x < 16; ++x)
        for (int y = 0; y < 10; ++y) {
            const std::uint32_t key = part.key_of(x, y);
            EXPECT_EQ(key, whole.key_of(x + 8, y + 5));
            const PathKey path{7, key, 11};
            EXPECT_EQ(some.generate(x, y, path).direction, all.generate(x + 8, y + 5, path).direction);
        }
}

}  // namespace
}  // namespace treefarm
