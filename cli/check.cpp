// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/option_values.h"
#include "common/base/text/printable.h"
#include "coordinator/input/check/validate.h"
#include "coordinator/input/lint/lint.h"
#include "coordinator/input/load.h"

namespace treefarm {

namespace {

/// Exit codes: kRefused is every command's code for bad input, and 1 to 4 have one meaning for all commands.
constexpr int kRefused = 2, kFoundSomething = 5;

struct CheckOptions {
    std::string scene;
    std::vector<std::string> defines;
    std::string sensor;
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

Finding refusal(const InputError& error) {
    return {Finding::Severity::error, "refused", error.where(), error.problem(), error.cure()};
}

/// Whether the scene itself sets farm.robust.
bool is_robust(const std::vector<Setting>& settings) {
    const auto at =
        std::find_if(settings.begin(), settings.end(), [](const Setting& s) { return s.key == "farm.robust"; });
    return at != settings.end() && at->value == "true";
}

bool is_error(const Finding& finding) {
    return finding.severity == Finding::Severity::error;
}

/// Findings of the reader and of inspection and, if none of them is an error, reasons for which a render would refuse
/// it.
std::vector<Finding> check(const CheckOptions& options) {
    SceneToCheck read = load_scene_to_check(options.scene, defined(options.defines), options.lenient, options.sensor);
    std::vector<Finding> findings = std::move(read.findings);
    const bool is_whole = std::none_of(findings.begin(), findings.end(), &is_error);
    for (Finding& finding : lint(read.scene))
        // A scene that was read in part may lack objects for that reason.
        if ((is_whole || !finding.kind.starts_with("no ")) && !(finding.kind == "far room" && is_robust(read.settings)))
            findings.push_back(std::move(finding));
    std::vector<Warning> repaired;  // each of these has a finding of its own
    try {
        if (std::none_of(findings.begin(), findings.end(), &is_error)) validate_scene(read.scene, repaired);
    } catch (const InputError& error) {
        findings.push_back(refusal(error));
    }
    for (Finding& finding : findings)
        if (finding.where.file.empty()) finding.where.file = options.scene;
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

/// Summary: "1 error, 2 warnings".
std::string verdict(std::ptrdiff_t errors, std::ptrdiff_t warnings) {
    const auto counted = [](std::ptrdiff_t count, const char* what) {
        return count == 0 ? "" : std::to_string(count) + what + (count == 1 ? "" : "s");
    };
    if (errors == 0 && warnings == 0) return "nothing risky";
    return counted(errors, " error") + (errors > 0 && warnings > 0 ? ", " : "") + counted(warnings, " warning");
}

int run_check(const CheckOptions& options, std::ostream& out) {
    std::vector<Finding> findings;
    try {
        findings = check(options);
    } catch (const InputError& error) {
        if (!options.json) throw;
        findings.push_back(refusal(error));
    }
    const auto errors = std::count_if(findings.begin(), findings.end(), &is_error);
    const auto warnings = std::count_if(findings.begin(), findings.end(), [](const Finding& f) {
        return f.severity != Finding::Severity::note && !is_error(f);
    });
    if (options.json) {
        out << to_json(findings, options.scene);
    } else {
        for (const Finding& finding : findings)
            out << printable(finding.text()) << "\n";
        out << printable(options.scene) << ": " << verdict(errors, warnings) << "\n";
    }
    if (errors > 0) return kRefused;
    return warnings == 0 ? 0 : kFoundSomething;
}

}  // namespace

void add_check_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto options = std::make_shared<CheckOptions>();
    CLI::App* command = app.add_subcommand("check", "Reports the risks in a scene, with their positions in the file");
    command->add_option("scene", options->scene, "Mitsuba scene (.xml)")->required();
    command->add_flag("--json", options->json, "print JSON instead of lines");
    add_texts_option(*command, "-D", options->defines, "name=value: gives $name in the scene a value");
    add_text_option(*command, "--sensor", options->sensor, "which of several sensors, by number from 0 on or by id");
    command->add_flag("--lenient", options->lenient, "replace unknown elements of the scene instead of refusing them");
    command->callback([options, launch, &exit_code] {
        if (launch.rank == 0) exit_code = run_check(*options, std::cout);  // under mpirun one process is enough
    });
}

}  // namespace treefarm
