// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/render.h"

namespace treefarm {

/// Folder of a shot.
std::filesystem::path shot_directory(const RenderOptions& options);

/// treefarm render --frames: renders every frame of a shot over all processes. Returns the exit code.
int render_shot(const LaunchEnvironment& launch, const RenderOptions& options);

}  // namespace treefarm
