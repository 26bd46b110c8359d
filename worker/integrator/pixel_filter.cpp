#include "worker/integrator/pixel_filter.h"

#include <algorithm>
#include <cmath>

namespace treefarm {
namespace {

/// exp(-x) for x >= 0 in plain double operations: the C library's exp may round differently on another machine.
double exp_negative(double x) {
    const double t = x / 1024.0;
    double term = 1.0, sum = 1.0;
    for (int i = 1; i <= 20; ++i) {
        term *= -t / i;
        sum += term;
    }
    for (int i = 0; i < 10; ++i)
        sum *= sum;
    return sum;
}

/// Cumulative masses, of 2^31, of the truncated Gaussian max(0, g(x) - g(radius)) over equal cells of [0, radius].
std::vector<std::uint32_t> gaussian_table(double radius, double stddev, std::uint32_t cells) {
    const double scale = 0.5 / (stddev * stddev);
    const double at_radius = exp_negative(scale * radius * radius);
    const double width = radius / cells;
    const auto value = [&](double x) { return exp_negative(scale * x * x) - at_radius; };
    std::vector<double> sums(cells + 1, 0.0);
    for (std::uint32_t i = 0; i < cells; ++i) {  // Simpson's rule
        const double x = i * width;
        sums[i + 1] = sums[i] + (value(x) + 4.0 * value(x + 0.5 * width) + value(x + width)) * (width / 6.0);
    }
    std::vector<std::uint32_t> table(cells + 1);
    for (std::uint32_t i = 0; i <= cells; ++i)
        table[i] = static_cast<std::uint32_t>(sums[i] / sums[cells] * 0x1p31);
    return table;
}

}  // namespace

FilterSampler::FilterSampler(const Film& film) : filter_(film.filter), radius_(film.filter_radius) {
    if (filter_ == PixelFilter::gaussian) cumulative_ = gaussian_table(radius_, film.filter_stddev, kCells);
}

float FilterSampler::sample(std::uint32_t random) const {
    if (filter_ == PixelFilter::box) return (2.0f * to_unit(random) - 1.0f) * radius_;
    const bool negative = random >> 31;
    const std::uint32_t bits = random & 0x7fffffffu;
    float magnitude;
    if (filter_ == PixelFilter::tent) {
        // P(|x| < a) = 1 - (1 - a/r)^2, inverted; (bits + 1/2) / 2^31 is never 1.
        const float rest = static_cast<float>(0x7fffffffu - bits) * 0x1p-31f;
        magnitude = radius_ * (1.0f - std::sqrt(rest));
    } else {
        const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, bits);
        const auto cell = static_cast<std::uint32_t>(above - cumulative_.begin()) - 1;
        const float begin = static_cast<float>(cumulative_[cell]), end = static_cast<float>(cumulative_[cell + 1]);
        const float within = end > begin ? (static_cast<float>(bits) - begin) / (end - begin) : 0.5f;
        magnitude = radius_ / static_cast<float>(kCells) * (static_cast<float>(cell) + std::clamp(within, 0.0f, 1.0f));
    }
    return negative ? -magnitude : magnitude;
}

}  // namespace treefarm
