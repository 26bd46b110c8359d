// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "coordinator/render/read_request.h"
#include "coordinator/render/render.h"

namespace treefarm {

/// Throws InputError if the folder is no run directory, or not yet.
void check_run_folder(const std::filesystem::path& run);

/// A request that continues the render in a run directory from its newest usable checkpoint. `input`: settings and
/// budget that are new; its file is that of the run directory. Throws InputError where the render cannot go on from
/// there to the same bits; nothing has been written then.
RenderRequest read_resumed(const std::filesystem::path& run, RenderInput input, const RenderOrigin& origin);

/// Lets a request continue what the folder that it names holds of it: from its newest usable checkpoint, or from the
/// start where there is none. Returns the outcome where its result is there, and has its output file made if that is
/// missing. Throws InputError where the folder holds a checkpoint of another render, and overwriting is not asked for.
std::optional<RenderOutcome> go_on_in_folder(RenderRequest& request);

/// The newest usable checkpoint of this very render in a run directory; nullptr where there is none.
std::shared_ptr<LoadedCheckpoint> find_checkpoint(const std::filesystem::path& run, const RenderRequest& request);

}  // namespace treefarm
