// SPDX-License-Identifier: Apache-2.0
// What cameras say of points against the rays that they send, and pixels against their filters.
#include "worker/camera/camera_importance.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/test_scenes.h"
#include "worker/camera/camera_rays.h"

namespace treefarm {
namespace {

struct CameraCase {
    std::string name;
    Camera camera;
    Film film;
};

std::vector<CameraCase> camera_cases() {
    Film film;
    film.width = 12;
    film.height = 9;
    Camera pinhole = test::look_at({0.2f, -0.3f, 3.0f}, {0, 0, 0}, {0.1f, 1, 0}, 0.5f);
    pinhole.corner += pinhole.across * 0.1f;  // shifted off its axis
    Camera lens = pinhole;
    lens.corner *= 2.5f;
    lens.across *= 2.5f;
    lens.down *= 2.5f;
    lens.lens_u = normalize(lens.across) * 0.3f;
    lens.lens_v = normalize(lens.down) * 0.2f;
    Camera tilted = lens;  // the lens does not face the plane of focus
    tilted.lens_u = Vec3(0.2f, 0.1f, 0.25f);
    Camera orthographic = pinhole;
    orthographic.origin = Vec3(0, 0, 3);
    orthographic.across = Vec3(1.5f, 0, 0);
    orthographic.down = Vec3(0, -1.2f, 0.1f);
    orthographic.corner = Vec3(-0.7f, 0.6f, 0);
    orthographic.parallel = normalize(Vec3(0.1f, 0.05f, -1));
    Camera panorama;
    panorama.origin = Vec3(0.2f, 0.1f, 0.8f);
    panorama.corner = normalize(Vec3(0.2f, 0.1f, -1));
    panorama.across = normalize(cross(Vec3(0, 1, 0), panorama.corner));
    panorama.down = cross(panorama.corner, panorama.across);
    panorama.panoramic = true;
    Film window = film;
    window.width = 5;
    window.height = 4;
    window.crop.x = 4;
    window.crop.y = 3;
    window.crop.whole_width = 12;
    window.crop.whole_height = 9;
    return {{"pinhole", pinhole, film},
            {"window", pinhole, window},
            {"lens", lens, film},
            {"tilted lens", tilted, film},
            {"orthographic", orthographic, film},
            {"panorama", panorama, film},
            {"panorama's window", panorama, window}};
}

Draw numbers(std::uint32_t i, Stream stream) {
    return draw({23, i, 0}, 0, stream);
}

TEST(CameraImportance, FindsTheFilmPositionOfItsRays) {
    for (const CameraCase& c : camera_cases()) {
        const CameraRays rays(c.camera, c.film);
        const CameraImportance importance(c.camera, c.film);
        const FilterSampler filter(c.film);
        for (std::uint32_t i = 0; i < 2000; ++i) {
            const Draw random = numbers(i, Stream::camera), more = numbers(i, Stream::scatter);
            const int x = static_cast<int>(more[0] % static_cast<unsigned>(c.film.width)),
                      y = static_cast<int>(more[1] % static_cast<unsigned>(c.film.height));
            const Ray ray = rays.generate(x, y, random);
            const float t = 0.1f + 10.0f * to_unit(more[2]);
            const FilmConnection to = importance.connect(ray.origin + ray.direction * t, {random[2], random[3], 0, 0});
            ASSERT_TRUE(to.seen) << c.name;
            EXPECT_NEAR(to.x, c.film.crop.x + x + 0.5 + double(filter.sample(random[0])), 2e-3) << c.name;
            EXPECT_NEAR(to.y, c.film.crop.y + y + 0.5 + double(filter.sample(random[1])), 2e-3) << c.name;
            EXPECT_GT(-dot(to.direction, ray.direction), 1 - 1e-5f) << c.name;
            EXPECT_LT((to.target - ray.origin).length(), 1e-4f) << c.name;
            if (c.camera.panoramic) continue;
            EXPECT_FALSE(importance.connect(ray.origin - ray.direction * t, {random[2], random[3], 0, 0}).seen)
                << c.name << ": behind it";
        }
    }
}

/// On a plane before the camera: shares of the film's rays that meet each part, and the integral of the importance.
TEST(CameraImportance, IsTheDensityOfRaysOnAPlane) {
    constexpr int kCells = 6;
    constexpr double kHalf = 2.5, kCellArea = 4 * kHalf * kHalf / (kCells * kCells);
    for (const CameraCase& c : camera_cases()) {
        const CameraRays rays(c.camera, c.film);
        const CameraImportance importance(c.camera, c.film);
        std::array<double, kCells * kCells> met{}, expected{}, squares{};
        constexpr std::uint32_t kRays = 400'000, kPoints = 20'000;
        std::uint32_t all = 0;
        for (std::uint32_t i = 0; i < kRays; ++i) {
            const Draw more = numbers(i, Stream::scatter);
            const Ray ray = rays.generate(static_cast<int>(more[0] % static_cast<unsigned>(c.film.width)),
                                          static_cast<int>(more[1] % static_cast<unsigned>(c.film.height)),
                                          numbers(i, Stream::camera));
            if (!(ray.direction.z < 0.0f)) continue;
            const Vec3 p = ray.origin - ray.direction * (ray.origin.z / ray.direction.z);
            const double u = (double(p.x) / kHalf + 1) * 0.5 * kCells, v = (double(p.y) / kHalf + 1) * 0.5 * kCells;
            if (!(u >= 0 && u < kCells && v >= 0 && v < kCells)) continue;
            met[static_cast<std::size_t>(static_cast<int>(v) * kCells + static_cast<int>(u))] += 1.0 / kRays;
            ++all;
        }
        EXPECT_GT(all, kRays / 50) << c.name;
        const Film& film = c.film;
        const double window = static_cast<double>(film.pixel_count()) / (film.whole_width() * film.whole_height());
        for (std::size_t cell = 0; cell < met.size(); ++cell) {
            for (std::uint32_t i = 0; i < kPoints; ++i) {
                const Draw at = numbers(i + kPoints * static_cast<std::uint32_t>(cell), Stream::light);
                const Vec3 p(
                    static_cast<float>((double(cell % kCells) + double(to_unit(at[0]))) / kCells * 2 * kHalf - kHalf),
                    static_cast<float>((double(cell / kCells) + double(to_unit(at[1]))) / kCells * 2 * kHalf - kHalf),
                    0.0f);
                const FilmConnection to = importance.connect(p, {at[2], at[3], 0, 0});
                const bool inside = to.seen && to.x >= film.crop.x && to.x < film.crop.x + film.width &&
                                    to.y >= film.crop.y && to.y < film.crop.y + film.height;
                const double value = inside ? to.g * std::abs(double(to.direction.z)) * kCellArea / window : 0.0;
                expected[cell] += value / kPoints;
                squares[cell] += value * value / kPoints;
            }
            const double variance = met[cell] / kRays + (squares[cell] - expected[cell] * expected[cell]) / kPoints;
            EXPECT_NEAR(met[cell], expected[cell], 4.8 * std::sqrt(std::max(variance, 0.0)) + 1e-6)
                << c.name << " cell " << cell;
        }
    }
}

/// The density per steradian is the importance without distance and cosine.
TEST(CameraImportance, DensityAndImportanceAgree) {
    for (const CameraCase& c : camera_cases()) {
        const CameraImportance importance(c.camera, c.film);
        const Vec3 p(0.1f, 0.2f, -0.3f);
        const FilmConnection to = importance.connect(p, {1u << 30, 1u << 29, 0, 0});
        if (c.camera.is_orthographic()) {
            EXPECT_EQ(to.direction_pdf, 0.0);
            continue;
        }
        const Vec3 d = p - to.target;
        EXPECT_NEAR(to.g * double(dot(d, d)), to.direction_pdf, 1e-4 * to.direction_pdf) << c.name;
    }
}

Film film_with(PixelFilter filter, float radius, bool window) {
    Film film;
    film.width = 7;
    film.height = 5;
    film.filter = filter;
    film.filter_radius = radius;
    if (!window) return film;
    film.width = 3;
    film.height = 2;
    film.crop.x = 4;
    film.crop.y = 1;
    film.crop.whole_width = 7;
    film.crop.whole_height = 5;
    return film;
}

struct Filter {
    PixelFilter filter;
    float radius;
};
constexpr Filter kFilters[] = {{PixelFilter::box, 0.5f},
                               {PixelFilter::box, 0.7f},
                               {PixelFilter::tent, 1.0f},
                               {PixelFilter::tent, 2.2f},
                               {PixelFilter::gaussian, 2.0f}};

TEST(PixelFilter, ValueIsTheDensityOfItsSamples) {
    for (const auto& [kind, radius] : kFilters) {
        const FilterSampler filter(film_with(kind, radius, false));
        constexpr int kBins = 10, kSamples = 200'000;
        std::array<double, kBins> counts{};
        for (std::uint32_t i = 0; i < kSamples; ++i) {
            const float at = filter.sample(numbers(i, Stream::camera)[0]);
            counts[static_cast<std::size_t>(
                std::clamp(static_cast<int>((at / radius + 1) * 0.5f * kBins), 0, kBins - 1))] += 1;
        }
        double whole = 0;
        for (int b = 0; b < kBins; ++b) {
            double integral = 0;
            for (int k = 0; k < 1000; ++k)
                integral +=
                    double(filter.value(
                        radius * (2 * (static_cast<float>(b) + (static_cast<float>(k) + 0.5f) / 1000) / kBins - 1))) *
                    2 * double(radius) / kBins / 1000;
            whole += integral;
            EXPECT_NEAR(counts[static_cast<std::size_t>(b)] / kSamples, integral,
                        4.5 * std::sqrt(integral / kSamples) + 1e-4)
                << radius;
        }
        EXPECT_NEAR(whole, 1.0, 1e-3) << radius;
        EXPECT_EQ(filter.value(1.001f * radius), 0.0f);
    }
}

TEST(PixelFilter, ValueOfOneWithLobesHasIntegralOne) {
    Film film = film_with(PixelFilter::cubic, 2.0f, false);
    const FilterSampler filter(film);
    double whole = 0;
    bool negative = false;
    for (int k = 0; k < 4000; ++k) {
        const float value = filter.value(2.0f * ((static_cast<float>(k) + 0.5f) / 2000 - 1));
        negative = negative || value < 0.0f;
        whole += double(value) * 2.0 / 2000;
    }
    EXPECT_NEAR(whole, 1.0, 1e-3);
    EXPECT_TRUE(negative);
}

/// Uniform positions over the film and around it: each pixel, those on the border too, gets the integral of its filter.
TEST(PixelPicker, EveryPixelGetsItsFilter) {
    for (const auto& [kind, radius] : kFilters)
        for (const bool window : {false, true})
            for (const bool panoramic : {false, true}) {
                const Film film = film_with(kind, radius, window);
                const PixelPicker picker(film, panoramic);
                const double whole = film.whole_width() * film.whole_height();
                const double reach = panoramic ? 0.0 : 3.0;  // all of a panorama is on its film
                const double width = film.whole_width() + 2 * reach, height = film.whole_height() + 2 * reach;
                std::vector<double> sum(film.pixel_count()), squares(film.pixel_count());
                constexpr std::uint32_t kSamples = 60'000;
                for (std::uint32_t i = 0; i < kSamples; ++i) {
                    const Draw at = numbers(i, Stream::light);
                    const double x = double(to_unit(at[0])) * width - reach,
                                 y = double(to_unit(at[1])) * height - reach;
                    const PixelPick pick = picker.pick(x, y, numbers(i, Stream::filter_pick));
                    if (!pick.found) continue;
                    EXPECT_TRUE(picker.reaches(x, y));
                    ASSERT_LT(pick.pixel, film.pixel_count());
                    const double value = pick.weight * width * height / whole * static_cast<double>(film.pixel_count());
                    sum[pick.pixel] += value / kSamples;
                    squares[pick.pixel] += value * value / kSamples;
                }
                for (std::size_t p = 0; p < sum.size(); ++p)
                    EXPECT_NEAR(sum[p], 1.0, 4.8 * std::sqrt((squares[p] - sum[p] * sum[p]) / kSamples))
                        << "pixel " << p << " radius " << radius << (window ? " window" : "")
                        << (panoramic ? " panorama" : "");
            }
}

/// A pixel of a panorama takes what its own rays see: those of its border pixels go on beyond pole and side.
TEST(PixelPicker, IsWhereTheCameraLooks) {
    for (const auto& [kind, radius] : kFilters)
        for (const CameraCase& c : camera_cases()) {
            Film film = c.film;
            film.filter = kind;
            film.filter_radius = radius;
            const CameraRays rays(c.camera, film);
            const CameraImportance importance(c.camera, film);
            const PixelPicker picker(film, c.camera.panoramic);
            for (std::uint32_t i = 0; i < 300; ++i) {
                const Draw random = numbers(i, Stream::camera), more = numbers(i, Stream::scatter);
                const auto pixel = static_cast<std::uint32_t>(more[0] % film.pixel_count());
                const auto width = static_cast<std::uint32_t>(film.width);
                const Ray ray = rays.generate(static_cast<int>(pixel % width), static_cast<int>(pixel / width), random);
                const FilmConnection to = importance.connect(ray.origin + ray.direction, {random[2], random[3], 0, 0});
                bool found = false;
                for (std::uint32_t k = 0; k < 400 && !found; ++k) {
                    const PixelPick pick = picker.pick(to.x, to.y, numbers(i * 400 + k, Stream::filter_pick));
                    found = pick.found && pick.pixel == pixel;
                }
                // A filter's last thousandth is hardly ever picked.
                const float edge = 0.9f * radius;
                const FilterSampler filter(film);
                if (std::abs(filter.sample(random[0])) > edge || std::abs(filter.sample(random[1])) > edge) continue;
                EXPECT_TRUE(found) << c.name << " radius " << radius << " pixel " << pixel;
            }
        }
}

}  // namespace
}  // namespace treefarm
