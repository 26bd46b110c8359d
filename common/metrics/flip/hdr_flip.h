// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/image/image.h"
#include "common/metrics/flip/flip.h"

namespace treefarm {

/// Exposures, as powers of two: `count` values, evenly spaced, both ends included.
struct ExposureRange {
    double start = 0.0;
    double stop = 0.0;
    int count = 2;
};

/// Tone curve of the publication, from radiance to [0, 1]: Narkowicz' fit of ACES (2015) after a factor of 0.6.
/// Negative radiance becomes black.
float tone_map(double radiance);

/// Range of exposures between the one that maps the reference's brightest luminance to 0.85 and the one that maps its
/// median there, in steps of about a stop. If the median is black, that of the other pixels is used; if all pixels are
/// black, the pixels of `image`; if those are black, too, the range is 0 to 0. Pixels that are NaN or infinite are
/// ignored.
ExposureRange exposure_range(const RgbImage& image, const RgbImage& reference);

/// FLIP of high dynamic range images, per pixel: the greatest FLIP over all exposures (Andersson et al. 2021,
/// "Visualizing Errors in Rendered High Dynamic Range Images"). The images must be finite, of equal size, and not
/// empty.
Plane hdr_flip(const RgbImage& image, const RgbImage& reference, const ExposureRange& exposures,
               double ppd = kDefaultPixelsPerDegree);

}  // namespace treefarm
