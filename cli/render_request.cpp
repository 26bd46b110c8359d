// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "cli/initial_model.h"
#include "cli/input_kind.h"
#include "cli/render.h"
#include "cli/this_build.h"
#include "common/base/hash.h"
#include "common/base/text/parse_text.h"
#include "common/config/check_job.h"
#include "common/config/job_keys.h"
#include "common/config/job_reader.h"
#include "common/plan/resolve/resolved_file.h"
#include "common/plan/schedule/schedule_file.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/display/display_server.h"
#include "coordinator/input/load.h"

namespace treefarm {

namespace {

Setting option_setting(const char* option, std::string key, std::string value) {
    return {std::move(key), std::move(value), Location{option, 0, 0}};
}

Setting define_setting(const std::string& define) {
    const std::size_t equals = define.find('=');
    if (equals == std::string::npos || equals == 0)
        throw InputError(Location{"-D " + define, 0, 0}, "a definition needs a name and a value",
                         "write -D name=value");
    return option_setting("-D", kDefinesPrefix + define.substr(0, equals), define.substr(equals + 1));
}

/// One budget on the command line replaces whatever budget the job has; spp leaves no room for another.
void add_budget(std::vector<Setting>& layer, const RenderOptions& options) {
    if (!options.spp && !options.seconds && !options.error) return;
    if (!options.schedule.empty())
        throw InputError(Location{"--schedule", 0, 0}, "says how long to render, as does another option",
                         "leave --spp, --seconds and --error away");
    if (options.spp && (options.seconds || options.error))
        throw InputError(Location{"--spp", 0, 0}, "cannot stand beside --seconds or --error",
                         "leave it away; to cap the samples, --set budget.max_spp=N");
    if (options.spp) layer.push_back(option_setting("--spp", "budget.spp", std::to_string(*options.spp)));
    layer.push_back(option_setting("--seconds", "budget.seconds", number_text(options.seconds.value_or(0.0))));
    layer.push_back(option_setting("--error", "budget.error", number_text(options.error.value_or(0.0))));
}

std::vector<Setting> command_line_layer(const RenderOptions& options) {
    std::vector<Setting> layer;
    for (const std::string& argument : options.set)
        layer.push_back(parse_set_argument(argument));
    for (const std::string& define : options.defines)
        layer.push_back(define_setting(define));
    add_budget(layer, options);
    if (options.lenient) layer.push_back(option_setting("--lenient", "scene.lenient", "true"));
    if (!options.sensor.empty()) layer.push_back(option_setting("--sensor", "scene.sensor", options.sensor));
    if (!options.run_directory.empty())
        layer.push_back(option_setting("--run-dir", "output.directory", options.run_directory));
    if (!options.output.empty()) layer.push_back(option_setting("-o", "output.file", options.output));
    return layer;
}

/// A budget that --set gives and another one makes void would be ignored in silence.
void check_budget_keys(const std::vector<Setting>& line, const RenderOptions& options, RenderRequest& request) {
    const Job::Budget& budget = request.job.budget;
    const char* const open = budget.seconds > 0 ? "budget.seconds" : budget.error > 0 ? "budget.error" : nullptr;
    for (const Setting& setting : line) {
        if (!setting.key.starts_with("budget.") || !setting.where.file.starts_with("--set")) continue;
        if (!options.schedule.empty() && setting.key != "budget.strict")
            throw InputError(setting.where, "--schedule says how long to render", "leave one of them away");
        if (setting.key == "budget.spp" && open != nullptr)
            throw InputError(setting.where, std::string(open) + " decides how many samples there are",
                             "to cap them, --set budget.max_spp=N; to have them instead, --spp N");
        if (setting.key == "budget.max_spp" && open == nullptr)
            request.warnings.emplace_back("budget.max_spp has no effect without --seconds or --error");
    }
}

/// The passes of a schedule file instead of the job's budget.
void replay(const std::string& file, RenderRequest& request) {
    request.schedule = parse_schedule(read_settings_text(file, "schedule"), file, resolve(request.job, request.scene));
    request.job.budget.seconds = request.job.budget.error = 0;
    request.job.budget.spp = request.schedule.back().first_sample + request.schedule.back().spp;
}

/// Where the passes of a job file stand that has them listed, unless the command line says how long to render.
std::string schedule_of(const RenderOptions& options, const JobFile& file, const std::vector<Setting>& line) {
    const bool has_budget = std::any_of(line.begin(), line.end(), [](const Setting& s) {
        return s.key.starts_with("budget.") && s.key != "budget.strict";
    });
    if (!options.schedule.empty() || has_budget || !file.experiment) return options.schedule;
    if (file.experiment->schedule.empty()) {
        for (const Setting& s : file.settings)
            if ((s.key == "budget.seconds" || s.key == "budget.error") && s.value != "0")
                throw InputError(s.where,
                                 s.key + " chose the passes, but experiment.schedule does not say where they are",
                                 "give that line back, name them with --schedule FILE, or say how long with --spp N");
        return "";
    }
    const std::filesystem::path schedule =
        std::filesystem::path(options.input).parent_path() / file.experiment->schedule;
    if (!std::filesystem::exists(schedule))
        throw InputError(file.experiment->schedule_where,
                         "its passes are those of " + schedule.string() + ", which is not there",
                         "name it with --schedule FILE, or say how long to render with --spp N");
    return schedule.string();
}

/// What on the command line changes the scene: "-D width", or "".
std::string scene_change(const std::vector<Setting>& line) {
    constexpr std::string_view kDefine = "scene.defines.";
    for (const Setting& s : line) {
        if (s.key.starts_with(kDefine)) return "-D " + s.key.substr(kDefine.size());
        if (s.key.starts_with("scene.") || s.key.starts_with("image.") || s.key.starts_with("effects."))
            return s.where.file;
    }
    return "";
}

}  // namespace

RenderRequest read_request(const RenderOptions& options) {
    require_scene_or_job(options.input);
    if (!options.display_server.empty()) parse_display_server(options.display_server);  // before the scene is read
    const std::filesystem::path input(options.input);
    JobFile file;
    std::vector<Setting>& file_layer = file.settings;
    if (input.extension() == ".toml")
        file = checked_job_file(read_job_settings(input));
    else
        file_layer.push_back({"scene.file", std::filesystem::absolute(input).string(), Location{options.input, 0, 0}});
    const std::vector<Setting> line_layer = command_line_layer(options);

    Job where;  // which scene, and how to read it, stands in the upper layers
    apply_layer(where, file_layer);
    apply_layer(where, line_layer);
    if (where.scene.file.empty())
        throw InputError(Location{options.input, 0, 0}, "the job names no scene", "set scene.file");
    LoadedScene loaded = load_scene(where.scene.file, where.scene.defines, where.scene.lenient, where.image.width,
                                    where.image.height, where.scene.sensor, scene_limits(where.scene));

    RenderRequest request;
    apply_layer(request.job, scene_layer(loaded.settings, {file_layer, line_layer}));
    apply_layer(request.job, file_layer);
    apply_layer(request.job, line_layer);
    check_job(request.job);
    check_budget_keys(line_layer, options, request);
    // --set scene.file=... is relative to the current folder, a name in job.toml to that of job.toml.
    request.job.scene.file = std::filesystem::absolute(request.job.scene.file).lexically_normal().string();
    request.scene = std::move(loaded.scene);
    if (const std::string schedule = schedule_of(options, file, line_layer); !schedule.empty())
        replay(schedule, request);
    if (options.reads_model) read_initial_model(request);
    request.plan = plan_effects(request.scene, request.job);
    if (file.experiment && options.holds_to_scene)
        require_scene(*file.experiment, hash_text(content_hash(encode_scene(request.scene))), kProgramVersion,
                      scene_change(line_layer));
    request.plan.passes_guessed |= !request.schedule.empty();
    for (const Warning& warning : loaded.warnings)
        request.warnings.push_back(warning.text());
    for (const Warning& note : loaded.notes)
        request.notes.push_back(note.text());
    const PassPlan last = plan_passes(request.plan.job).back();
    if (const std::uint32_t spp = last.first_sample + last.spp;
        !request.plan.passes_guessed && spp != static_cast<std::uint32_t>(request.job.budget.spp))
        request.warnings.push_back(
            std::to_string(request.job.budget.spp) + " spp become " + std::to_string(spp) +
            ": passes take multiples of guiding.spp_unit = " + std::to_string(request.job.guiding.spp_unit));
    request.plan.warnings = request.warnings;  // what the reader had to replace belongs to the plan, too
    request.command = options.command;
    request.debug_command = debug_command(options);
    request.fingerprint = this_build();
    request.display_server = options.display_server;
    request.overwrite = options.overwrite;
    return request;
}

std::string debug_command(const RenderOptions& options) {
    std::error_code error;  // whole paths, so that it can be pasted anywhere
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    std::string text = shell_quoted(error ? "treefarm" : program.string()) + " render " +
                       shell_quoted(std::filesystem::absolute(options.input).string());
    for (const std::string& argument : options.set)
        text += " --set " + shell_quoted(argument);
    for (const std::string& define : options.defines)
        text += " -D " + shell_quoted(define);
    // --spp, --seconds and --error are left out: the passes that they led to come as a schedule.
    if (!options.schedule.empty())
        text += " --schedule " + shell_quoted(std::filesystem::absolute(options.schedule).string());
    if (!options.sensor.empty()) text += " --sensor " + shell_quoted(options.sensor);
    if (options.lenient) text += " --lenient";
    return text + " --debug-sample";
}

}  // namespace treefarm
