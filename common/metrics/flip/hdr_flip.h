// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/image/image.h"
#include "common/metrics/flip/flip.h"

namespace treefarm {

/// Exposures c at which radiance is shown as 2^c times itself: `count` of them, evenly spaced, both ends included.
struct ExposureRange {
    double start = 0.0;
    double stop = 0.0;
    int count = 2;
};

/// Tone curve of the publication, from radiance to [0, 1]: Narkowicz' fit of ACES (2015) behind a factor 0.6. What is
/// negative is shown as black.
float tone_map(double radiance);

/// The range from the exposure that shows the reference's brightest luminance as 0.85 to the one that shows its median
/// so, in steps of about a stop. Where the median is black, that of the pixels that are not; where all are black, those
/// of the `image` take their place, and 0 to 0 if they are black too. Pixels that are NaN or infinite do not count.
ExposureRange exposure_range(const RgbImage& image, const RgbImage& reference);

/// FLIP of high dynamic range images per pixel: the greatest FLIP over all exposures (Andersson et al. 2021,
/// "Visualizing Errors in Rendered High Dynamic Range Images"). The images must be finite, of one size, and not empty.
Plane hdr_flip(const RgbImage& image, const RgbImage& reference, const ExposureRange& exposures,
               double ppd = kDefaultPixelsPerDegree);

}  // namespace treefarm
