// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

#include "cli/launch_environment.h"
#include "common/metrics/flip/kernels.h"

namespace CLI {
class App;
}

namespace treefarm {

/// treefarm compare IMAGE.exr REFERENCE.exr
struct CompareOptions {
    std::string image;
    std::string reference;
    bool json = false;
    std::string difference;  ///< where to write the false-colour difference; empty: nowhere
    std::string error_map;   ///< where to write FLIP per pixel, .png (false colour) or .exr (values); empty: nowhere
    double flip_ppd = kDefaultPixelsPerDegree;  ///< pixels per degree of visual angle
    int block = 16;                             ///< side of a block in pixels
    /// Samples per pixel of a reference without variance channels, rendered by an estimator like the image's: its
    /// variance is then the image's times image spp / reference spp. 0: the reference counts as exact (up to rounding
    /// to half).
    std::uint64_t reference_spp = 0;
    double reference_error = 0.0;  ///< standard deviation of a relative error that all of the reference shares
};

/// Prints the comparison to `out` and returns 0: verdicts are in the output. Throws InputError for images that cannot
/// be read or compared, RunError if a picture cannot be written.
int run_compare(const CompareOptions& options, std::ostream& out);

/// Registers the subcommand. Its callback calls run_compare with standard output and stores the exit code; InputError
/// and RunError leave CLI::App::parse.
void add_compare_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code);

}  // namespace treefarm
