// SPDX-License-Identifier: Apache-2.0
#include "worker/camera/pixel_filter.h"

#include <algorithm>
#include <cmath>

#include "common/scene/model/filter_lobes.h"

namespace treefarm {
namespace {

/// exp(-x) for x >= 0 in plain double operations: the C library's exp may round differently on another machine.
double exp_of_minus(double x) {
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

/// Integrals of the truncated Gaussian max(0, g(x) - g(radius)) over equal bins of [0, radius].
std::vector<double> gaussian_masses(double radius, double stddev, std::uint32_t bins) {
    const double scale = 0.5 / (stddev * stddev);
    const double at_radius = exp_of_minus(scale * radius * radius);
    return bin_masses([&](double x) { return exp_of_minus(scale * x * x) - at_radius; }, radius, bins);
}

/// Cumulative sums of the absolute masses, scaled to 2^31.
std::vector<std::uint32_t> cumulative_table(const std::vector<double>& masses) {
    std::vector<double> sums(masses.size() + 1, 0.0);
    for (std::size_t i = 0; i < masses.size(); ++i)
        sums[i + 1] = sums[i] + std::abs(masses[i]);
    std::vector<std::uint32_t> table(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        table[i] = static_cast<std::uint32_t>(sums[i] / sums.back() * 0x1p31);
    return table;
}

}  // namespace

FilterSampler::FilterSampler(const Film& film) : filter_(film.filter), radius_(film.filter_radius) {
    if (filter_ == PixelFilter::gaussian)
        cumulative_ = cumulative_table(gaussian_masses(radius_, film.filter_stddev, kBins));
    if (!film.is_signed()) return;
    const std::vector<double> masses = lobe_masses(film, kBins);
    cumulative_ = cumulative_table(masses);
    for (const double mass : masses)
        negative_.push_back(mass < 0);
    weight_ = static_cast<float>(excess_of(masses));
}

std::uint32_t FilterSampler::bin_of(std::uint32_t bits) const {
    const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, bits);
    return static_cast<std::uint32_t>(above - cumulative_.begin()) - 1;
}

float FilterSampler::weight(std::uint32_t random) const {
    return !negative_.empty() && negative_[bin_of(random & 0x7fffffffu)] ? -weight_ : weight_;
}

float FilterSampler::value(float offset) const {
    // Half-open, so that a point on the edge of two box filters belongs to one pixel.
    if (!(offset >= -radius_ && offset < radius_)) return 0.0f;
    if (filter_ == PixelFilter::box) return 0.5f / radius_;
    const float magnitude = std::abs(offset);
    if (filter_ == PixelFilter::tent) return (1.0f - magnitude / radius_) / radius_;
    const float bins = static_cast<float>(kBins) / radius_;
    const std::uint32_t bin = std::min(static_cast<std::uint32_t>(magnitude * bins), kBins - 1);
    const float density = static_cast<float>(cumulative_[bin + 1] - cumulative_[bin]) * 0x1p-32f * bins;
    return !negative_.empty() && negative_[bin] ? -weight_ * density : weight_ * density;
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
        const std::uint32_t bin = bin_of(bits);
        const auto begin = static_cast<float>(cumulative_[bin]), end = static_cast<float>(cumulative_[bin + 1]);
        const float within = end > begin ? (static_cast<float>(bits) - begin) / (end - begin) : 0.5f;
        magnitude = radius_ / static_cast<float>(kBins) * (static_cast<float>(bin) + std::clamp(within, 0.0f, 1.0f));
    }
    return negative ? -magnitude : magnitude;
}

}  // namespace treefarm
