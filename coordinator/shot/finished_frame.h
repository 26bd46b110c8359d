// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/run/render_run.h"
#include "coordinator/shot/frame_record.h"

namespace treefarm {

/// Tells a record what the run directory says of its render, if that has ended: samples, seconds, error.
void read_figures(const std::filesystem::path& folder, FrameRecord& record);

/// Whether a run directory's render is done and was this request, by the same program: equal job, scene and fingerprint
/// give equal images.
bool holds_result_of(const std::filesystem::path& folder, const RenderRequest& request);

/// Whether a run directory's render is done, whatever it was.
bool holds_result(const std::filesystem::path& folder);

/// Makes the request's output file of what the run directory holds, where it is missing. Returns whether it is there.
bool restore_output(const std::filesystem::path& folder, const std::string& file);

}  // namespace treefarm
