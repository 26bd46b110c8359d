#include "cli/plan.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/render.h"
#include "common/plan/plan_text.h"

namespace treefarm {

namespace {

int run_plan(const RenderOptions& options, bool json, std::ostream& out) {
    const RenderRequest request = read_request(options);
    const std::string& scene = request.job.scene.file;
    out << (json ? plan_json(request.plan, scene) : plan_text(request.plan, scene));
    return 0;
}

}  // namespace

void add_plan_command(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<RenderOptions>();
    const auto json = std::make_shared<bool>(false);
    CLI::App* command = app.add_subcommand("plan", "Tells what a render would simulate, why, and what it costs");
    command->add_option("input", options->input, "Mitsuba scene (.xml) or job (.toml)")->required();
    command->add_flag("--json", *json, "print JSON instead of a table");
    command->add_option("--spp", options->spp, "samples per pixel");
    command->add_option("--set", options->set, "key=value: sets a key of the job")->allow_extra_args(false);
    command->add_option("-D", options->defines, "name=value: gives $name in the scene a value")
        ->allow_extra_args(false);
    command->add_flag("--lenient", options->lenient, "replace what the scene reader does not know instead of refusing");
    command->callback([options, json, &exit_code] { exit_code = run_plan(*options, *json, std::cout); });
}

}  // namespace treefarm
