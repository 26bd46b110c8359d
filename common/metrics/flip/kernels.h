// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numbers>

#include "common/metrics/flip/separable_filter.h"

namespace treefarm {

/// Pixels per degree of visual angle in the middle of a screen: distance and width in metres, width in pixels.
constexpr double pixels_per_degree(double distance, double width, double pixels_across) {
    return distance * (pixels_across / width) * (std::numbers::pi / 180.0);
}

/// Viewing conditions of the publication: 67.02 pixels per degree.
inline constexpr double kDefaultPixelsPerDegree = pixels_per_degree(0.7, 0.7, 3840.0);

/// Blur of the opponent colours by contrast sensitivity, as separable factors: K(x, y) = k[x] k[y]. The kernel of Cz is
/// a sum of two Gaussians, hence a sum of two such products.
struct SensitivityKernels {
    Kernel y, cx, cz_narrow, cz_wide;
};

/// Gaussian and its first and second derivative. Weights of one sign sum to 1 or -1, so responses to steps and lines
/// are in [-1, 1] at any resolution.
struct FeatureKernels {
    Kernel gaussian, first, second;
};

/// Kernels of FLIP (Andersson et al. 2020). Domain: `ppd` in [1, 1000] pixels per degree.
SensitivityKernels sensitivity_kernels(double ppd);
FeatureKernels feature_kernels(double ppd);

}  // namespace treefarm
