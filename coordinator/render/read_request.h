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

/// Budget of a render; empty: that of the settings.
struct RenderBudget {
    std::optional<std::uint32_t> spp{};  ///< samples per pixel; for a resumed render in total
    std::optional<double> seconds{};     ///< seconds of rendering; for a resumed render in total
    std::optional<double> error{};       ///< target RMSE / mean luminance
    std::string schedule{};              ///< file with the passes to repeat, a schedule.toml
};

/// Input of a render, as the user names it.
struct RenderInput {
    std::string file{};               ///< Mitsuba scene (.xml) or job (.toml)
    std::vector<Setting> settings{};  ///< job keys, with precedence over the scene and the job file
    RenderBudget budget{};            ///< precedes all settings
    bool reads_model = true;          ///< guiding.initial_model has not been read yet
    bool holds_to_scene = true;       ///< the scene must be that of the resolved.toml
};

/// Reads job and scene. Layers of the job, each over the previous one: defaults, the scene file's integrator and
/// sampler, the job file, the input's settings, its budget. Throws InputError.
RenderRequest read_request(const RenderInput& input, const RenderOrigin& origin = {});

/// Job from a loaded scene and layers of settings, each over the previous one; unchecked.
Job merged_job(const LoadedScene& loaded, std::initializer_list<std::span<const Setting>> layers);

/// Adds the messages of the scene's reader.
void take_warnings(const LoadedScene& loaded, RenderContent& content);

/// Reads the model that guiding.initial_model of the request's job names, and adds its hash and number of samples to
/// the job. A render that gave guiding up has none: the job then begins without a model, with a warning. Throws
/// InputError if it is no run directory, or the model is another guide's, or not the one of the job's hash.
void read_initial_model(RenderRequest& request);

/// Throws InputError, with advice, if the input of render, plan or debug is neither a Mitsuba scene nor a job: a run
/// directory has a job.toml, a study's folder a report.
void require_scene_or_job(const std::string& input);

/// Throws InputError if the input of study is no study file by its name.
void require_study_file(const std::string& input);

}  // namespace treefarm
