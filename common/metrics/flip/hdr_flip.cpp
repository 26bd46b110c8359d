// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/flip/hdr_flip.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace treefarm {

namespace {

// y(x) = (k0 x^2 + k1 x) / (k2 x^2 + k3 x + k4).
constexpr double kScale = 0.6;
constexpr double k0 = kScale * kScale * 2.51, k1 = kScale * 0.03;
constexpr double k2 = kScale * kScale * 2.43, k3 = kScale * 0.59, k4 = 0.14;
constexpr double kShown = 0.85;  ///< tone-mapped value of the brightest or the median luminance

/// Positive x with y(x) = kShown: the larger root of a quadratic.
double shown_radiance() {
    const double a = k0 - kShown * k2, b = k1 - kShown * k3, c = -kShown * k4;
    return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

/// Luminances of the finite pixels.
std::vector<double> luminances(const RgbImage& image) {
    std::vector<double> values;
    values.reserve(image.pixels.size());
    for (const Rgb& pixel : image.pixels)
        if (is_finite(pixel)) values.push_back(luminance(Imath::Color3<double>(pixel)));
    return values;
}

double greatest(const std::vector<double>& values) {
    return values.empty() ? 0.0 : *std::max_element(values.begin(), values.end());
}

/// Median; the upper one of an even number, as in the authors' program.
double upper_median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

RgbImage shown(const RgbImage& image, double exposure) {
    RgbImage result(image.width, image.height);
    const double factor = std::exp2(exposure);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            result.pixels[i][c] = tone_map(factor * image.pixels[i][c]);
    return result;
}

}  // namespace

float tone_map(double radiance) {
    const double x = std::clamp(radiance, 0.0, 1e6);  // beyond, the result is white, and squares could overflow
    return static_cast<float>(std::min((k0 * x + k1) * x / ((k2 * x + k3) * x + k4), 1.0));
}

ExposureRange exposure_range(const RgbImage& image, const RgbImage& reference) {
    std::vector<double> values = luminances(reference);
    if (!(greatest(values) > 0.0)) values = luminances(image);
    const double brightest = greatest(values);
    if (!(brightest > 0.0)) return {};
    double median = upper_median(values);
    if (!(median > 0.0)) {
        std::erase_if(values, [](double v) { return !(v > 0.0); });
        median = upper_median(values);
    }
    const double shown_as_bright = shown_radiance();
    ExposureRange range{std::log2(shown_as_bright / brightest), std::log2(shown_as_bright / median)};
    range.count = std::max(2, static_cast<int>(std::ceil(range.stop - range.start)));
    return range;
}

Plane hdr_flip(const RgbImage& image, const RgbImage& reference, const ExposureRange& exposures, double ppd) {
    Plane result(image.width, image.height);
    for (int k = 0; k < exposures.count; ++k) {
        const double exposure = exposures.start + (exposures.stop - exposures.start) * k / (exposures.count - 1);
        const Plane map = flip(shown(image, exposure), shown(reference, exposure), ppd);
        for (std::size_t i = 0; i < map.values.size(); ++i)
            result.values[i] = std::max(result.values[i], map.values[i]);
    }
    return result;
}

}  // namespace treefarm
