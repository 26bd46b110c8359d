#include "cli/study.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>

#include "cli/input_kind.h"
#include "cli/on_farm.h"
#include "cli/option_values.h"
#include "cli/this_build.h"
#include "coordinator/study/study_run.h"
#include "report/price_list.h"
#include "report/study_report.h"

namespace treefarm {

namespace {

struct StudyOptions {
    std::string input;
    std::string directory;
    FarmOptions farm;
    bool dry_run = false;
    bool overwrite = false;
    std::string command;
};

Study read_study_for(const StudyOptions& options) {
    require_study_file(options.input);
    Study study = read_study(options.input);
    if (!options.directory.empty()) study.directory = options.directory;
    return study;
}

int exit_code_of(RunState state) {
    return state == RunState::done ? 0 : state == RunState::interrupted ? 3 : 1;
}

int study(const LaunchEnvironment& launch, const StudyOptions& options) {
    if (options.dry_run) {
        if (launch.rank == 0) list_cells(read_study_for(options), this_build(), std::cout);
        return 0;
    }
    if (is_separate_world(launch)) return 2;
    Study study;
    FarmTask task;
    const Voice voice = make_voice(launch, options.farm);
    const Log log = make_log("treefarm", {}, voice.console, voice.loudness);
    task.prepare = [&] {
        study = read_study_for(options);
        std::vector<std::string> warnings;
        warn_if_crowded(options.farm.threads, warnings);
        for (const std::string& warning : warnings)
            log->warn("{}", warning);
    };
    task.coordinate = [&](Channel& channel, const std::function<bool()>& interrupted) -> CoordinatorEnd {
        const StudyOutcome outcome = run_study(
            channel, study, {options.command, this_build(), voice.console, voice.loudness, options.overwrite, log},
            interrupted);
        return {exit_code_of(outcome.state), outcome.lost_peers};
    };
    const int code = run_on_farm(launch, options.farm, voice, task);
    if (code == 0 && launch.rank == 0) {
        const WrittenReport report = write_study_report(study.directory);
        for (const std::string& answer : report.answers)
            log->info("{}", answer);
        if (!report.warning.empty()) log->warn("{}", report.warning);
        log->info("report: {}", report.page.string());
    }
    return code;
}

/// The page's path for scripts, what it says for people.
void tell(const WrittenReport& report) {
    for (const std::string& answer : report.answers)
        std::cerr << answer << "\n";
    if (!report.warning.empty()) std::cerr << "warning: " << report.warning << "\n";
    std::cout << report.page.string() << "\n";
}

}  // namespace

void add_report_command(CLI::App& app, const LaunchEnvironment& launch) {
    const auto folders = std::make_shared<std::vector<std::string>>();
    const auto prices = std::make_shared<std::string>();
    const auto benches = std::make_shared<std::vector<std::string>>();
    CLI::App* command = app.add_subcommand("report", "Writes the reports of studies, or of what is done of them");
    command->add_option("folder", *folders, "folders that treefarm study wrote")->required();
    add_text_option(*command, "--price-list", *prices,
                    "also write what each method costs and buys, as Markdown, to this file");
    add_texts_option(*command, "--bench", *benches, "in that file, also what this JSON file of a benchmark says")
        ->needs("--price-list");
    command->callback([folders, benches, prices, launch] {
        if (launch.rank != 0) return;
        for (const std::string& folder : *folders)
            tell(write_study_report(folder));
        if (!prices->empty())
            write_price_list({folders->begin(), folders->end()}, {benches->begin(), benches->end()}, *prices);
    });
}

void add_study_command(CLI::App& app, const LaunchEnvironment& launch, const std::string& command_line,
                       int& exit_code) {
    const auto options = std::make_shared<StudyOptions>();
    options->command = command_line;
    CLI::App* command = app.add_subcommand("study", "Renders a matrix of methods, scenes and seeds, and compares them");
    command->add_option("input", options->input, "study file (.toml)")->required();
    add_text_option(*command, "--dir", options->directory, "where results go (default: directory in the file)");
    add_farm_options(*command, options->farm);
    command->add_flag("--overwrite", options->overwrite, "replace the other study that the folder holds");
    command->add_flag("--dry-run", options->dry_run, "list the cells, and which are done; render nothing");
    command->footer(kExitCodesText);
    command->callback([options, launch, &exit_code] { exit_code = study(launch, *options); });
}

}  // namespace treefarm
