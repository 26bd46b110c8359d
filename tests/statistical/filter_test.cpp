// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>

#include "common/scene/model/filter_lobes.h"
#include "tests/support/chi_square.h"
#include "worker/camera/pixel_filter.h"

namespace treefarm {
namespace {

constexpr double kFilterSignificance = 1e-4;

double filter_p_value(const Film& film, const std::function<double(double)>& shape) {
    const FilterSampler sampler(film);
    constexpr int kBins = 200, kSteps = 200;
    constexpr std::uint32_t kSamples = 1000000;
    const double radius = film.filter_radius;
    std::vector<double> counts(kBins, 0.0), expected(kBins, 0.0);
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const double x = sampler.sample(draw({1, i, 0}, 0, Stream::camera)[0]);
        counts[std::min<std::size_t>(kBins - 1, static_cast<std::size_t>((x + radius) / (2 * radius) * kBins))] += 1;
    }
    double total = 0;
    for (int i = 0; i < kBins * kSteps; ++i) {
        const double value = shape(((i + 0.5) / (kBins * kSteps) * 2 - 1) * radius);
        expected[static_cast<std::size_t>(i / kSteps)] += value;
        total += value;
    }
    for (double& e : expected)
        e *= kSamples / total;
    return test::chi_square_test(counts, expected);
}

TEST(FilterDistribution, Box) {
    Film film;
    EXPECT_GT(filter_p_value(film, [](double) { return 1.0; }), kFilterSignificance);
}

TEST(FilterDistribution, Tent) {
    Film film;
    film.filter = PixelFilter::tent;
    film.filter_radius = 1.25f;
    EXPECT_GT(filter_p_value(film, [](double x) { return 1.25 - std::abs(x); }), kFilterSignificance);
}

TEST(FilterDistribution, Gaussian) {
    for (const float stddev : {0.25f, 0.5f, 1.0f}) {
        Film film;
        film.filter = PixelFilter::gaussian;
        film.filter_stddev = stddev;
        film.filter_radius = 2.0f;
        const auto gauss = [&](double x) { return std::exp(-x * x / (2.0 * stddev * stddev)); };
        EXPECT_GT(filter_p_value(film, [&](double x) { return gauss(x) - gauss(2.0); }), kFilterSignificance) << stddev;
    }
}

std::vector<Film> films_with_lobes() {
    Film mitchell, catmullrom, lanczos;
    mitchell.filter = catmullrom.filter = PixelFilter::cubic;
    mitchell.filter_radius = catmullrom.filter_radius = 2.0f;
    mitchell.filter_b = mitchell.filter_c = 1.0f / 3;
    lanczos.filter = PixelFilter::lanczos;
    lanczos.filter_radius = 3.0f;
    return {mitchell, catmullrom, lanczos};
}

/// Filters of the films above, as their authors write them.
double lobes(std::size_t film, double x) {
    x = std::abs(x);
    if (film == 2) return x == 0 ? 1 : std::sin(M_PI * x) * std::sin(M_PI * x / 3) / (M_PI * x * M_PI * x / 3);
    if (film == 1) return x < 1 ? 1.5 * x * x * x - 2.5 * x * x + 1 : -0.5 * x * x * x + 2.5 * x * x - 4 * x + 2;
    return (x < 1 ? 7 * x * x * x - 12 * x * x + 16.0 / 3 : -7.0 / 3 * x * x * x + 12 * x * x - 20 * x + 32.0 / 3) / 6;
}

TEST(FilterDistribution, NegativeLobesAreDrawnByTheirAbsoluteValue) {
    const std::vector<Film> films = films_with_lobes();
    for (std::size_t f = 0; f < films.size(); ++f)
        EXPECT_GT(filter_p_value(films[f], [&](double x) { return std::abs(lobes(f, x)); }), kFilterSignificance) << f;
}

/// A pixel at distance `edge` from a step shows the filter's integral on its bright side.
TEST(FilterDistribution, WeightedSamplesConvolve) {
    const std::vector<Film> films = films_with_lobes();
    constexpr std::uint32_t kSamples = 400000;
    for (std::size_t f = 0; f < films.size(); ++f) {
        const FilterSampler sampler(films[f]);
        const double radius = films[f].filter_radius;
        for (const double edge : {-9.0, -2.5, -1.3, -0.5, 0.0, 0.4, 1.2, 2.2}) {  // -9: constant radiance
            double bright = 0, all = 0, sum = 0, squares = 0;
            for (int i = 0; i < 200000; ++i) {
                const double x = ((i + 0.5) / 100000 - 1) * radius;
                all += lobes(f, x);
                if (x > edge) bright += lobes(f, x);
            }
            for (std::uint32_t i = 0; i < kSamples; ++i) {
                const std::uint32_t random = draw({1, i, 0}, 0, Stream::camera)[0];
                const double value = double(sampler.sample(random)) > edge ? double(sampler.weight(random)) : 0.0;
                sum += value;
                squares += value * value;
            }
            const double mean = sum / kSamples, deviation = std::sqrt((squares / kSamples - mean * mean) / kSamples);
            EXPECT_NEAR(mean, bright / all, 4.5 * deviation + 1e-6) << f << " at " << edge;
            if (edge == -9.0) {
                EXPECT_NEAR(std::pow(squares / kSamples, 2), sign_cost(films[f]), 1e-3) << f;
            }
        }
    }
    EXPECT_EQ(sign_cost(Film()), 1.0);
}

TEST(FilterDistribution, TheTestCanFail) {
    Film film;
    film.filter = PixelFilter::gaussian;
    film.filter_radius = 2.0f;
    EXPECT_LT(filter_p_value(film, [](double x) { return std::exp(-x * x / (2 * 0.52 * 0.52)); }), kFilterSignificance);
}

}  // namespace
}  // namespace treefarm
