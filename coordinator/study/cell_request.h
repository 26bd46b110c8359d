// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "coordinator/input/load.h"
#include "coordinator/run/render_run.h"
#include "coordinator/study/study.h"

namespace treefarm {

/// Reads a scene of a study. Throws InputError.
LoadedScene load_study_scene(const Study& study, const StudyScene& scene);

/// A render of a study, everything but its folder and its turn. Layers, each over the one before: the scene's own, the
/// study's [job], the scene's, `method`, `more`. Throws InputError.
RenderRequest study_request(const Study& study, const StudyScene& scene, const LoadedScene& loaded,
                            std::span<const Setting> method, std::span<const Setting> more, const Fingerprint& build);

/// Settings that a cell has beyond its method: a budget and the seed.
std::vector<Setting> cell_settings(const Study& study, const StudyCell& cell);

/// Names what a request renders: job without its output, scene, program, and `more` (the reference that it is measured
/// against). Equal keys, equal numbers but for the clock's.
std::uint64_t request_key(const RenderRequest& request, const std::string& more);

/// A folder's name that tells a person what is in it, and ends in the key.
std::string folder_name(const std::string& words, std::uint64_t key);

}  // namespace treefarm
