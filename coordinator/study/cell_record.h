// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "common/image/image.h"
#include "coordinator/passes/pass_loop.h"

namespace treefarm {

/// A pass of a cell, with the image as it was after it.
struct MeasuredPass {
    PassReport report;
    RgbImage image;
};

/// Part of a cell's cell.json about its render: every pass with its figures and its true errors against the reference,
/// and FLIP of the last (docs/use/studies.md).
nlohmann::ordered_json render_record(const std::vector<MeasuredPass>& passes, const RgbImage& reference);

}  // namespace treefarm
