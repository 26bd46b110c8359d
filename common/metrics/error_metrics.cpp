// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/error_metrics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/base/error.h"

namespace treefarm {

namespace {

/// Offset that keeps relative errors finite where the reference is black; the usual value for relMSE.
constexpr double kEpsilon = 0.01;
constexpr std::size_t kTrimOneIn = 1000;
constexpr double kOutlierMedians = 100.0;
constexpr double kLeastOutlier = 1.0;

using Rgb64 = Imath::Color3<double>;

struct PixelPair {
    std::size_t index;
    Rgb64 a, b;
};

std::vector<PixelPair> comparable(const RgbImage& image, const RgbImage& reference, ErrorMetrics& m) {
    std::vector<PixelPair> pairs;
    pairs.reserve(image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const bool image_valid = is_valid(image.pixels[i]), reference_valid = is_valid(reference.pixels[i]);
        if (!image_valid) ++m.invalid_image;
        if (!reference_valid) ++m.invalid_reference;
        if (image_valid && reference_valid) pairs.push_back({i, Rgb64(image.pixels[i]), Rgb64(reference.pixels[i])});
    }
    return pairs;
}

double ratio(double a, double b) {
    return b > 0.0 ? a / b : ErrorMetrics::kUndefined;
}

double pixel_rel_mse(const PixelPair& p) {
    double sum = 0.0;
    for (int c = 0; c < 3; ++c) {
        const double d = p.a[c] - p.b[c];
        sum += d * d / (p.b[c] * p.b[c] + kEpsilon);
    }
    return sum / 3.0;
}

void sum_errors(const std::vector<PixelPair>& pairs, ErrorMetrics& m) {
    double square = 0.0, relative_square = 0.0, relative = 0.0, symmetric = 0.0;
    Rgb64 a(0.0), b(0.0);
    for (const PixelPair& p : pairs) {
        for (int c = 0; c < 3; ++c) {
            const double d = std::abs(p.a[c] - p.b[c]);
            square += d * d;
            relative += d / (std::abs(p.b[c]) + kEpsilon);
            symmetric += 2.0 * d / (std::abs(p.a[c]) + std::abs(p.b[c]) + kEpsilon);
        }
        relative_square += pixel_rel_mse(p);
        a += p.a;
        b += p.b;
    }
    const auto n = static_cast<double>(pairs.size());
    m.mse = square / (3.0 * n);
    m.rmse = std::sqrt(m.mse);
    m.rel_mse = relative_square / n;
    m.mape = relative / (3.0 * n);
    m.smape = symmetric / (3.0 * n);
    m.mean_image = luminance(a) / n;
    m.mean_reference = luminance(b) / n;
    m.mean_ratio = ratio(luminance(a), luminance(b));
    for (int c = 0; c < 3; ++c)
        m.channel_ratio[c] = ratio(a[c], b[c]);
}

std::vector<double> relative_errors(const std::vector<PixelPair>& pairs) {
    std::vector<double> errors(pairs.size());
    std::transform(pairs.begin(), pairs.end(), errors.begin(), pixel_rel_mse);
    return errors;
}

/// Adds the errors of all pixels but the `trimmed` worst, in pixel order; of equal errors the later pixel is dropped
/// first.
void sum_trimmed(const std::vector<PixelPair>& pairs, const std::vector<double>& error, ErrorMetrics& m) {
    std::vector<std::size_t> order(pairs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const std::size_t kept = pairs.size() - pairs.size() / kTrimOneIn;
    const auto better = [&](std::size_t i, std::size_t j) {
        return error[i] != error[j] ? error[i] < error[j] : i < j;
    };
    if (kept < order.size())
        std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), order.end(), better);
    order.resize(kept);
    std::sort(order.begin(), order.end());
    double sum = 0.0, a = 0.0, b = 0.0;
    for (const std::size_t i : order) {
        sum += error[i];
        a += luminance(pairs[i].a);
        b += luminance(pairs[i].b);
    }
    m.trimmed = pairs.size() - kept;
    m.rel_mse_trimmed = sum / static_cast<double>(kept);
    m.mean_ratio_trimmed = ratio(a, b);
}

double median(std::vector<double> values) {
    if (values.empty()) return ErrorMetrics::kUndefined;
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

void count_outliers(const std::vector<PixelPair>& pairs, const std::vector<double>& errors, int width,
                    ErrorMetrics& m) {
    m.outlier_limit = std::max(kLeastOutlier, kOutlierMedians * median(errors));
    m.outliers = static_cast<std::uint64_t>(
        std::count_if(errors.begin(), errors.end(), [&](double e) { return e > m.outlier_limit; }));
    const auto worst = std::max_element(errors.begin(), errors.end());
    const std::size_t pixel = pairs[static_cast<std::size_t>(worst - errors.begin())].index;
    m.worst = *worst;
    m.worst_x = static_cast<int>(pixel % static_cast<std::size_t>(width));
    m.worst_y = static_cast<int>(pixel / static_cast<std::size_t>(width));
}

bool has_negative(const Rgb64& c) {
    return c.x < 0.0 || c.y < 0.0 || c.z < 0.0;
}

void count_negatives(const std::vector<PixelPair>& pairs, ErrorMetrics& m) {
    for (const PixelPair& p : pairs) {
        if (has_negative(p.a)) ++m.negative_image;
        if (has_negative(p.b)) ++m.negative_reference;
    }
}

double median_block_ratio(const std::vector<PixelPair>& pairs, int width, int height, int block) {
    const auto w = static_cast<std::size_t>(width), side = static_cast<std::size_t>(block);
    const std::size_t across = (w + side - 1) / side, down = (static_cast<std::size_t>(height) + side - 1) / side;
    std::vector<double> a(across * down, 0.0), b(across * down, 0.0);
    for (const PixelPair& p : pairs) {
        const std::size_t at = p.index / w / side * across + p.index % w / side;
        a[at] += luminance(p.a);
        b[at] += luminance(p.b);
    }
    std::vector<double> ratios;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (b[i] > 0.0) ratios.push_back(a[i] / b[i]);
    return median(std::move(ratios));
}

}  // namespace

void require_same_size(const RgbImage& image, const RgbImage& reference) {
    if (image.width == reference.width && image.height == reference.height && !image.pixels.empty()) return;
    throw InputError("the image has " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                     " pixels, the reference " + std::to_string(reference.width) + " x " +
                     std::to_string(reference.height) + "; only images of one size can be compared");
}

ErrorMetrics measure_error(const RgbImage& image, const RgbImage& reference, int block) {
    require_same_size(image, reference);
    ErrorMetrics m;
    m.pixels = image.pixels.size();
    const std::vector<PixelPair> pairs = comparable(image, reference, m);
    m.compared = pairs.size();
    if (pairs.empty()) return m;
    sum_errors(pairs, m);
    count_negatives(pairs, m);
    const std::vector<double> errors = relative_errors(pairs);
    sum_trimmed(pairs, errors, m);
    count_outliers(pairs, errors, image.width, m);
    m.block_ratio_median = median_block_ratio(pairs, image.width, image.height, std::max(1, block));
    return m;
}

}  // namespace treefarm
