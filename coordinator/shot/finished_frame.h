// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/run/render_run.h"
#include "coordinator/shot/frame_record.h"

namespace treefarm {

/// Fills a record's figures from the run directory, if its render has ended: samples, seconds, error.
void read_figures(const std::filesystem::path& folder, FrameRecord& record);

/// Whether a run directory holds the finished render of this request, by the same program: equal job, scene and
/// fingerprint give equal images.
bool holds_result_of(const std::filesystem::path& folder, const RenderRequest& request);

/// Whether a run directory holds a finished render of any request.
bool holds_result(const std::filesystem::path& folder);

/// Restores the request's output file from the run directory, if it is missing. Returns whether it exists.
bool restore_output(const std::filesystem::path& folder, const std::string& file);

}  // namespace treefarm
