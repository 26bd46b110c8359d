// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "coordinator/input/load.h"
#include "coordinator/render/render_request.h"
#include "coordinator/study/study.h"

namespace treefarm {

/// Reads a scene of a study. Throws InputError.
LoadedScene load_study_scene(const Study& study, const StudyScene& scene);

/// Request of a study's render, without its folder and turn. Layers, each over the previous one: the scene's own
/// settings, the study's [job], the study's settings of the scene, `method`, `more`. Throws InputError.
RenderRequest study_request(const Study& study, const StudyScene& scene, const LoadedScene& loaded,
                            std::span<const Setting> method, std::span<const Setting> more, const RenderOrigin& origin);

/// Settings of a cell besides its method: budget and seed.
std::vector<Setting> cell_settings(const Study& study, const StudyCell& cell);

/// Name of a cell: "scene.method.seed", with the budget before the seed if the study has several.
std::string cell_words(const Study& study, const StudyCell& cell);

/// Key of a request's result: a hash of job without its output, scene, program, and `more` (the reference that it is
/// compared with). Equal keys mean equal figures, except for times.
std::uint64_t request_key(const RenderRequest& request, const std::string& more);

/// Folder name of `words`, readable for a person, and the key.
std::string folder_name(const std::string& words, std::uint64_t key);

/// A cell's request with its folder.
struct ReadyCell {
    RenderRequest request;
    std::filesystem::path folder;

    /// Whether the folder holds a finished cell.
    bool done() const;
};
ReadyCell ready_cell(const Study& study, const StudyCell& cell, const LoadedScene& loaded,
                     const std::string& reference_key, const RenderOrigin& origin);

}  // namespace treefarm
