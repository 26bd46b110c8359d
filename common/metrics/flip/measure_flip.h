// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/metrics/error_metrics.h"
#include "common/metrics/flip/hdr_flip.h"

namespace treefarm {

/// Figures of a FLIP map over the pixels that are not NaN; undefined (NaN) where there is none.
struct FlipFigures {
    double mean = ErrorMetrics::kUndefined;
    /// The value up to which the errors, from the least on, make up half of their sum: what the publication reports
    /// beside the mean, since many small errors do not hide few large ones in it.
    double weighted_median = ErrorMetrics::kUndefined;
    double max = ErrorMetrics::kUndefined;
};

struct FlipMetrics {
    double ppd = kDefaultPixelsPerDegree;
    ExposureRange exposures;
    Plane hdr_map;  ///< NaN where a pixel is NaN or infinite in either image
    FlipFigures hdr;
    FlipFigures ldr;  ///< of the images as shown without tone curve, clamped to [0, 1]
};

FlipFigures flip_figures(const Plane& map);

/// Pixels that are NaN or infinite in either image are left out; for the filters of their neighbours both show the
/// reference there, or black. `ppd` in [1, 1000]. Throws InputError if the sizes differ.
FlipMetrics measure_flip(const RgbImage& image, const RgbImage& reference, double ppd = kDefaultPixelsPerDegree);

}  // namespace treefarm
