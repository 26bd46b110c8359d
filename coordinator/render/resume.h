// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "coordinator/render/read_request.h"
#include "coordinator/render/render.h"

namespace treefarm {

/// Throws InputError if a folder is no run directory, or not yet.
void check_run_folder(const std::filesystem::path& run);

/// Request that resumes the render in a run directory from its newest usable checkpoint. `input`: new settings and
/// budget; its file is that of the run directory. Throws InputError, before anything is written, if the render could
/// not continue to the same bits.
RenderRequest read_resumed(const std::filesystem::path& run, RenderInput input, const RenderOrigin& origin);

/// Lets a request resume from its folder: from the newest usable checkpoint, or from the start without one. Returns the
/// outcome if its result exists already, after restoring a missing output file. Throws InputError if the folder holds
/// another render's checkpoint, unless overwriting is allowed.
std::optional<RenderOutcome> go_on_in_folder(RenderRequest& request);

/// Newest usable checkpoint of this render in a run directory; nullptr if there is none.
std::shared_ptr<LoadedCheckpoint> find_checkpoint(const std::filesystem::path& run, const RenderRequest& request);

}  // namespace treefarm
