// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "coordinator/render/render_request.h"

namespace treefarm {

/// Figures of a finished render.
struct RenderFigures {
    std::uint32_t spp = 0;
    double seconds = 0;
    std::optional<double> error;  ///< relative; unknown with one sample per pixel
    bool missed_target = false;   ///< its error is above budget.error
    std::filesystem::path image;  ///< path of the image
};

/// Figures from a run directory's summary; missing ones are unknown.
RenderFigures read_figures(const std::filesystem::path& folder);

/// Whether a run directory holds the finished render of this request, by the same program: equal job, scene and
/// fingerprint give equal images.
bool holds_result_of(const std::filesystem::path& folder, const RenderRequest& request);

/// Whether a run directory holds a finished render of any request.
bool holds_result(const std::filesystem::path& folder);

/// Restores the request's output file from the run directory, if it is missing. Returns whether it exists.
bool restore_output(const std::filesystem::path& folder, const std::string& file);

}  // namespace treefarm
