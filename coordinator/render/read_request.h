// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coordinator/input/load.h"
#include "coordinator/render/render_request.h"

namespace treefarm {

/// Length of a render. Empty: by the settings.
struct RenderBudget {
    std::optional<std::uint32_t> spp{};  ///< samples per pixel; of a render that continues, in all
    std::optional<double> seconds{};     ///< of rendering; of a render that continues, in all
    std::optional<double> error{};       ///< stop at this RMSE / mean luminance
    std::string schedule{};              ///< file: repeat the passes of this schedule.toml
};

/// Source of a render: files and settings, as a person names them.
struct RenderInput {
    std::string file{};               ///< Mitsuba scene (.xml) or job (.toml)
    std::vector<Setting> settings{};  ///< keys of a job, over those of the scene and the job file
    RenderBudget budget{};            ///< over all of them
    bool reads_model = true;          ///< guiding.initial_model is to be read
    bool holds_to_scene = true;       ///< the scene has to be that of a resolved.toml
};

/// Reads job and scene. The job's layers, each over the one before: defaults, the scene file's integrator and sampler,
/// the job file, the input's settings, its budget. Throws InputError.
RenderRequest read_request(const RenderInput& input, const RenderOrigin& origin = {});

/// The job of a scene that was read, and layers of settings, each over the one before; not checked.
Job merged_job(const LoadedScene& loaded, std::initializer_list<std::span<const Setting>> layers);

/// Adds the warnings and notes of the scene's reader.
void take_warnings(const LoadedScene& loaded, RenderContent& content);

}  // namespace treefarm
