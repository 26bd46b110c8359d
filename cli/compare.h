// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

#include "common/metrics/flip/kernels.h"

namespace treefarm {

/// Options of treefarm compare IMAGE.exr REFERENCE.exr
struct CompareOptions {
    std::string image;
    std::string reference;
    bool json = false;
    std::string difference;  ///< output file of the false-colour difference; empty: none
    std::string error_map;   ///< output file of FLIP per pixel, .png (false colour) or .exr (values); empty: none
    double flip_ppd = kDefaultPixelsPerDegree;  ///< pixels per degree of visual angle
    int block = 16;                             ///< side of a block in pixels
    /// Samples per pixel of a reference without variance channels, rendered by an estimator like the image's: its
    /// variance is then the image's times image spp / reference spp. 0: the reference counts as exact (up to rounding
    /// to half).
    std::uint64_t reference_spp = 0;
    double reference_error = 0.0;  ///< standard deviation of a relative error common to all of the reference
};

/// Prints the comparison to `out` and returns 0, whatever the result. Throws InputError for images that cannot be read
/// or compared, RunError if a picture cannot be written.
int run_compare(const CompareOptions& options, std::ostream& out);

}  // namespace treefarm
