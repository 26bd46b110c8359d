// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "coordinator/render/render_request.h"

namespace treefarm {

/// Figures of a render that has ended.
struct RenderFigures {
    std::uint32_t spp = 0;
    double seconds = 0;
    std::optional<double> error;  ///< relative; unknown of a render of one sample, say
    bool missed_target = false;   ///< its error is above budget.error
    std::filesystem::path image;  ///< where it is
};

/// Figures that a run directory's summary has, as far as it has any.
RenderFigures read_figures(const std::filesystem::path& folder);

/// Whether a run directory holds the finished render of this request, by the same program: equal job, scene and
/// fingerprint give equal images.
bool holds_result_of(const std::filesystem::path& folder, const RenderRequest& request);

/// Whether a run directory holds a finished render of any request.
bool holds_result(const std::filesystem::path& folder);

/// Restores the request's output file from the run directory, if it is missing. Returns whether it exists.
bool restore_output(const std::filesystem::path& folder, const std::string& file);

}  // namespace treefarm
