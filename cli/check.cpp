#include "cli/check.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/scene/inspect.h"
#include "common/scene/load.h"
#include "common/scene/validate.h"

namespace treefarm {

namespace {

/// 1 to 4 have a meaning for every command.
constexpr int kFoundSomething = 5;

struct CheckOptions {
    std::string scene;
    std::vector<std::string> defines;
    bool lenient = false, json = false;
};

std::map<std::string, std::string> defined(const std::vector<std::string>& defines) {
    std::map<std::string, std::string> values;
    for (const std::string& define : defines) {
        const std::size_t equals = define.find('=');
        if (equals == std::string::npos || equals == 0)
            throw InputError(Location{"-D " + define, 0, 0}, "a definition needs a name and a value",
                             "write -D name=value");
        values[define.substr(0, equals)] = define.substr(equals + 1);
    }
    return values;
}

/// What the reader warned of, what inspection finds, and, if that is no error, what a render would refuse.
std::vector<Finding> check(const CheckOptions& options) {
    LoadedScene loaded = load_scene_unchecked(options.scene, defined(options.defines), options.lenient);
    std::vector<Finding> findings;
    for (const Warning& warning : loaded.warnings)
        findings.push_back({Finding::Severity::warning, "reader", warning.where, warning.what, ""});
    for (Finding& finding : inspect(loaded.scene))
        findings.push_back(std::move(finding));
    const bool refused = std::any_of(findings.begin(), findings.end(),
                                     [](const Finding& f) { return f.severity == Finding::Severity::error; });
    if (refused) return findings;
    std::vector<Warning> repaired;  // each has a finding of its own
    try {
        validate_scene(loaded.scene, repaired);
    } catch (const InputError& error) {
        findings.push_back({Finding::Severity::error, "refused", {}, error.what(), ""});
    }
    return findings;
}

std::string to_json(const std::vector<Finding>& findings, const std::string& scene) {
    nlohmann::ordered_json json = {{"scene", scene}, {"findings", nlohmann::json::array()}};
    for (const Finding& f : findings)
        json["findings"].push_back(nlohmann::ordered_json{{"severity", name_of(f.severity)},
                                                          {"kind", f.kind},
                                                          {"file", f.where.file},
                                                          {"line", f.where.line},
                                                          {"column", f.where.column},
                                                          {"what", f.what},
                                                          {"cure", f.cure}});
    // A path need not be UTF-8.
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

int run_check(const CheckOptions& options, std::ostream& out) {
    const std::vector<Finding> findings = check(options);
    const auto risky = std::count_if(findings.begin(), findings.end(),
                                     [](const Finding& f) { return f.severity != Finding::Severity::note; });
    if (options.json) {
        out << to_json(findings, options.scene);
    } else {
        for (const Finding& finding : findings)
            out << finding.text() << "\n";
        out << options.scene << ": " << (risky == 0 ? "nothing risky" : std::to_string(risky) + " risky") << "\n";
    }
    return risky == 0 ? 0 : kFoundSomething;
}

}  // namespace

void add_check_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto options = std::make_shared<CheckOptions>();
    CLI::App* command = app.add_subcommand("check", "Tells what in a scene is risky, with places");
    command->add_option("scene", options->scene, "Mitsuba scene (.xml)")->required();
    command->add_flag("--json", options->json, "print JSON instead of lines");
    command->add_option("-D", options->defines, "name=value: gives $name in the scene a value")
        ->allow_extra_args(false);
    command->add_flag("--lenient", options->lenient, "replace what the scene reader does not know instead of refusing");
    command->callback([options, launch, &exit_code] {
        if (launch.rank == 0) exit_code = run_check(*options, std::cout);  // under mpirun one process is enough
    });
}

}  // namespace treefarm
