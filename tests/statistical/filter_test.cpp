#include <gtest/gtest.h>

#include <functional>

#include "tests/support/chi_square.h"
#include "worker/integrator/pixel_filter.h"

namespace treefarm {
namespace {

constexpr double kSignificance = 1e-4;

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
    EXPECT_GT(filter_p_value(film, [](double) { return 1.0; }), kSignificance);
}

TEST(FilterDistribution, Tent) {
    Film film;
    film.filter = PixelFilter::tent;
    film.filter_radius = 1.25f;
    EXPECT_GT(filter_p_value(film, [](double x) { return 1.25 - std::abs(x); }), kSignificance);
}

TEST(FilterDistribution, Gaussian) {
    for (const float stddev : {0.25f, 0.5f, 1.0f}) {
        Film film;
        film.filter = PixelFilter::gaussian;
        film.filter_stddev = stddev;
        film.filter_radius = 2.0f;
        const auto gauss = [&](double x) { return std::exp(-x * x / (2.0 * stddev * stddev)); };
        EXPECT_GT(filter_p_value(film, [&](double x) { return gauss(x) - gauss(2.0); }), kSignificance) << stddev;
    }
}

TEST(FilterDistribution, TheTestCanFail) {
    Film film;
    film.filter = PixelFilter::gaussian;
    film.filter_radius = 2.0f;
    EXPECT_LT(filter_p_value(film, [](double x) { return std::exp(-x * x / (2 * 0.52 * 0.52)); }), kSignificance);
}

}  // namespace
}  // namespace treefarm
