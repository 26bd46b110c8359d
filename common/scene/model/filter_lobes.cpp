// SPDX-License-Identifier: Apache-2.0
#include "common/scene/model/filter_lobes.h"

#include <cmath>

namespace treefarm {
namespace {

/// Sine of pi x by plain operations: the C library's sine may round differently on another machine.
double sin_pi(double x) {
    const double whole = std::floor(x + 0.5);
    const double t = M_PI * (x - whole), t2 = t * t;
    double term = t, sum = t;
    for (int i = 1; i <= 9; ++i) {
        term *= -t2 / (2 * i * (2 * i + 1));
        sum += term;
    }
    return std::fmod(whole, 2.0) == 0.0 ? sum : -sum;
}

/// Normalised sinc: sin(pi x) / (pi x).
double sinc(double x) {
    return x < 1e-9 ? 1.0 : sin_pi(x) / (M_PI * x);
}

/// Cubic filter of Mitchell and Netravali, "Reconstruction Filters in Computer Graphics" (1988); B = 0, C = 1/2 is
/// Catmull and Rom's.
double cubic(double x, double b, double c) {
    if (x < 1.0) return (((12 - 9 * b - 6 * c) * x + (-18 + 12 * b + 6 * c)) * x * x + 6 - 2 * b) / 6;
    if (x < 2.0) return ((((-b - 6 * c) * x + 6 * b + 30 * c) * x - 12 * b - 48 * c) * x + 8 * b + 24 * c) / 6;
    return 0.0;
}

}  // namespace

double lobe_value(const Film& film, double x) {
    x = std::abs(x);
    if (film.filter == PixelFilter::cubic) return cubic(x, double(film.filter_b), double(film.filter_c));
    return x < double(film.filter_radius) ? sinc(x) * sinc(x / double(film.filter_radius)) : 0.0;
}

std::vector<double> bin_masses(const std::function<double(double)>& value, double radius, std::uint32_t bins) {
    const double width = radius / bins;
    std::vector<double> masses(bins);
    for (std::uint32_t i = 0; i < bins; ++i) {  // Simpson's rule
        const double x = i * width;
        masses[i] = (value(x) + 4.0 * value(x + 0.5 * width) + value(x + width)) * (width / 6.0);
    }
    return masses;
}

std::vector<double> lobe_masses(const Film& film, std::uint32_t bins) {
    return bin_masses([&](double x) { return lobe_value(film, x); }, double(film.filter_radius), bins);
}

double excess_of(const std::vector<double>& masses) {
    double sum = 0, absolute = 0;
    for (const double mass : masses) {
        sum += mass;
        absolute += std::abs(mass);
    }
    return absolute / sum;
}

double sign_cost(const Film& film) {
    if (!film.is_signed()) return 1.0;
    const double excess = excess_of(lobe_masses(film, 512));
    return excess * excess * excess * excess;
}

}  // namespace treefarm
