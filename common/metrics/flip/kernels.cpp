// SPDX-License-Identifier: Apache-2.0
#include "common/metrics/flip/kernels.h"

#include <cmath>
#include <numbers>
#include <numeric>

namespace treefarm {

namespace {

constexpr double kPi2 = std::numbers::pi * std::numbers::pi;

/// Term a sqrt(pi / b) exp(-pi^2 d^2 / b) of the contrast sensitivity at d degrees from the centre; b in square
/// degrees.
struct Sensitivity {
    double a, b;
};

// Andersson et al. 2020.
constexpr Sensitivity kAchromatic{1.0, 0.0047}, kRedGreen{1.0, 0.0053};
constexpr Sensitivity kBlueYellow[2] = {{34.1, 0.04}, {13.5, 0.025}};
constexpr double kFeatureWidth = 0.082;  ///< degrees: width of the edges and points to be detected

/// Radius in pixels of all kernels: three standard deviations of the widest term.
int sensitivity_radius(double ppd) {
    return static_cast<int>(std::ceil(3.0 * std::sqrt(kBlueYellow[0].b / (2.0 * kPi2)) * ppd));
}

/// Square roots of the term's weights along one axis; the term's two-dimensional weight is their product.
std::vector<double> axis_weights(const Sensitivity& term, double ppd) {
    const int radius = sensitivity_radius(ppd);
    std::vector<double> weights;
    for (int i = -radius; i <= radius; ++i) {
        const double degrees = i / ppd;
        weights.push_back(std::sqrt(term.a * std::sqrt(std::numbers::pi / term.b)) *
                          std::exp(-kPi2 * degrees * degrees / term.b));
    }
    return weights;
}

double sum(const std::vector<double>& weights) {
    return std::accumulate(weights.begin(), weights.end(), 0.0);
}

Kernel divided(const std::vector<double>& weights, double divisor) {
    Kernel kernel;
    for (const double w : weights)
        kernel.push_back(static_cast<float>(w / divisor));
    return kernel;
}

Kernel normalised(const std::vector<double>& weights) {
    return divided(weights, sum(weights));
}

/// Scales the positive weights to sum 1 and the negative ones to sum -1.
Kernel balanced(const std::vector<double>& weights) {
    double positive = 0.0, negative = 0.0;
    for (const double w : weights)
        (w > 0.0 ? positive : negative) += std::abs(w);
    Kernel kernel;
    for (const double w : weights)
        kernel.push_back(static_cast<float>(w / (w > 0.0 ? positive : negative)));
    return kernel;
}

}  // namespace

SensitivityKernels sensitivity_kernels(double ppd) {
    const std::vector<double> narrow = axis_weights(kBlueYellow[1], ppd), wide = axis_weights(kBlueYellow[0], ppd);
    const double both = std::hypot(sum(narrow), sum(wide));  // the sum over the plane is that of the squares
    return {normalised(axis_weights(kAchromatic, ppd)), normalised(axis_weights(kRedGreen, ppd)), divided(narrow, both),
            divided(wide, both)};
}

FeatureKernels feature_kernels(double ppd) {
    const double deviation = 0.5 * kFeatureWidth * ppd;
    const int radius = static_cast<int>(std::ceil(3.0 * deviation));
    std::vector<double> gaussian, first, second;
    for (int i = -radius; i <= radius; ++i) {
        const double t = i / deviation, g = std::exp(-0.5 * t * t);
        gaussian.push_back(g);
        first.push_back(-t * g);
        second.push_back((t * t - 1.0) * g);
    }
    return {normalised(gaussian), balanced(first), balanced(second)};
}

}  // namespace treefarm
