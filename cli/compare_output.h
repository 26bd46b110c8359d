// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>

#include "common/metrics/error_metrics.h"
#include "common/metrics/flip/measure_flip.h"
#include "common/metrics/z_test.h"

namespace treefarm {

/// Results of `treefarm compare`.
struct Comparison {
    std::string image, reference;
    int width = 0, height = 0;
    std::optional<std::uint64_t> image_spp;
    ErrorMetrics errors;
    FlipMetrics flip;
    std::string reference_noise;  ///< origin of the reference's variance
    std::string z_unavailable;    ///< reason why there are no z-tests; empty if there are
    ZTestOptions z_options;
    PixelZTest pixel_test;
    BlockZTest block_test;
};

void print_table(const Comparison& comparison, std::ostream& out);

/// Prints the comparison as one JSON object; undefined figures are null.
void print_json(const Comparison& comparison, std::ostream& out);

}  // namespace treefarm
