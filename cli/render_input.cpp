// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <utility>

#include "cli/render.h"
#include "cli/this_build.h"
#include "common/base/text/parse_text.h"
#include "common/config/job_keys.h"
#include "common/config/job_reader.h"
#include "coordinator/display/display_server.h"

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

/// Command that traces one sample again, without the sample's name.
std::string debug_command(const RenderOptions& options) {
    std::error_code error;  // absolute paths, so that the command works from any folder
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    std::string text = shell_quoted(error ? "treefarm" : program.string()) + " render ";
    text += shell_quoted(std::filesystem::absolute(options.input, error).string());  // "" stays ""
    for (const std::string& argument : options.set)
        text += " --set " + shell_quoted(argument);
    for (const std::string& define : options.defines)
        text += " -D " + shell_quoted(define);
    // --spp, --seconds and --error are omitted: their passes are listed in a schedule.
    if (!options.budget.schedule.empty())
        text += " --schedule " + shell_quoted(std::filesystem::absolute(options.budget.schedule).string());
    if (!options.sensor.empty()) text += " --sensor " + shell_quoted(options.sensor);
    if (options.lenient) text += " --lenient";
    return text + " --debug-sample";
}

}  // namespace

RenderInput render_input(const RenderOptions& options) {
    if (!options.display_server.empty()) parse_display_server(options.display_server);  // before the scene is read
    RenderInput input{.file = options.input, .budget = options.budget};
    std::vector<Setting>& settings = input.settings;
    for (const std::string& argument : options.set)
        settings.push_back(parse_set_argument(argument));
    for (const std::string& define : options.defines)
        settings.push_back(define_setting(define));
    if (options.lenient) settings.push_back(option_setting("--lenient", "scene.lenient", "true"));
    if (!options.sensor.empty()) settings.push_back(option_setting("--sensor", "scene.sensor", options.sensor));
    if (!options.run_directory.empty())
        settings.push_back(option_setting("--run-dir", "output.directory", options.run_directory));
    if (!options.output.empty()) settings.push_back(option_setting("-o", "output.file", options.output));
    return input;
}

RenderOrigin render_origin(const RenderOptions& options) {
    return {.command = options.command, .debug_command = debug_command(options), .fingerprint = this_build()};
}

RenderRequest read_request(const RenderOptions& options) {
    RenderRequest request = read_request(render_input(options), render_origin(options));
    request.storage.overwrite = options.overwrite;
    request.storage.display_server = options.display_server;
    return request;
}

}  // namespace treefarm
