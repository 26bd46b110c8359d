// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/metrics/error_metrics.h"
#include "common/metrics/flip/hdr_flip.h"

namespace treefarm {

/// Statistics of a FLIP map over its pixels that are not NaN; NaN if there are none.
struct FlipFigures {
    double mean = ErrorMetrics::kUndefined;
    /// Weighted median: errors up to this value, in ascending order, make up half of the sum of all. The publication
    /// reports it beside the mean, since many small errors do not hide a few large ones in it.
    double weighted_median = ErrorMetrics::kUndefined;
    double max = ErrorMetrics::kUndefined;
};

struct FlipMetrics {
    double ppd = kDefaultPixelsPerDegree;
    ExposureRange exposures;
    Plane hdr_map;  ///< NaN where a pixel is NaN or infinite in either image
    FlipFigures hdr;
    FlipFigures ldr;  ///< of the images clamped to [0, 1], without tone curve
};

FlipFigures flip_figures(const Plane& map);

/// FLIP of two images. Pixels that are NaN or infinite in either image are left out; the filters of their neighbours
/// see the reference there, or black. `ppd` in [1, 1000] pixels per degree. Throws InputError if the sizes differ.
FlipMetrics measure_flip(const RgbImage& image, const RgbImage& reference, double ppd = kDefaultPixelsPerDegree);

}  // namespace treefarm
