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

/// Everything that `treefarm compare` found.
struct Comparison {
    std::string image, reference;
    int width = 0, height = 0;
    std::optional<std::uint64_t> image_spp;
    ErrorMetrics errors;
    FlipMetrics flip;
    std::string reference_noise;  ///< where the reference's variance comes from
    std::string z_unavailable;    ///< why there are no z-tests; empty if there are
    ZTestOptions z_options;
    PixelZTest pixel_test;
    BlockZTest block_test;
};

void print_table(const Comparison& comparison, std::ostream& out);

/// One JSON object; undefined figures are null.
void print_json(const Comparison& comparison, std::ostream& out);

}  // namespace treefarm
