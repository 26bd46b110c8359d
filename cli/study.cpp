// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/observer.h"
#include "cli/option_values.h"
#include "cli/plan_answer.h"
#include "cli/probe_here.h"
#include "cli/this_build.h"
#include "common/base/host.h"
#include "common/runs/run_files.h"
#include "coordinator/render/read_request.h"
#include "coordinator/study/study_list.h"
#include "coordinator/study/study_run.h"
#include "report/figure_export.h"
#include "report/price_list.h"
#include "report/run_results.h"
#include "report/study_report.h"

namespace treefarm {

namespace {

struct StudyOptions {
    std::string input;
    std::string directory;
    FarmOptions farm;
    bool dry_run = false;
    bool no_probe = false;
    std::optional<double> probe_seconds;
    bool overwrite = false;
    std::string command;
};

struct ReportOptions {
    std::vector<std::string> folders;
    std::string output, figures, width, prices;
    std::vector<std::string> benches;
    FigureStyle style;
};

Study read_study_for(const StudyOptions& options) {
    require_study_file(options.input);
    Study study = read_study(options.input);
    if (!options.directory.empty()) study.directory = options.directory;
    return study;
}

/// Default length of a dry run's probes, in seconds: each scene and method has one.
constexpr double kProbeOfCell = 1;

/// Lists the cells, and what the missing ones cost: a budget of seconds by itself, other budgets by probes.
int dry_run(const StudyOptions& options) {
    const unsigned threads = options.farm.threads > 0 ? options.farm.threads : affinity_threads();
    std::map<std::string, std::pair<Probe, double>> probes;  // by scene and method, with the ratio of pixels
    bool interrupted = false;
    const CostOfRender cost = [&](RenderRequest& request, const std::string& name) -> std::optional<Expected> {
        const Resolved& job = request.content.plan.job;
        Expected seconds{job.budget.seconds, job.budget.seconds, job.budget.seconds};
        if (job.budget.seconds == 0 || job.budget.error > 0) {
            if (options.no_probe || interrupted) return {};
            const auto [at, is_new] = probes.try_emplace(name);
            auto& [probe, pixel_ratio] = at->second;
            if (is_new) {
                std::fprintf(stderr, "treefarm: probing %s\n", name.c_str());
                auto [on_film, ratio] = smaller_film(request);
                pixel_ratio = ratio;
                probe = probe_here(on_film, options.probe_seconds.value_or(kProbeOfCell), threads);
                interrupted = probe.interrupted;
            }
            const Expectation expected = answer_by_probe(job, probe, pixel_ratio).expected;
            if (interrupted || !expected.known) return {};
            seconds = expected.seconds;
        }
        return Expected{threads * seconds.value, threads * seconds.low, threads * seconds.high};
    };
    const StudyCost all = list_cells(read_study_for(options), {.fingerprint = this_build()}, cost, std::cout);
    if (const std::string text = cost_text(all); !text.empty())
        std::cout << text << "; this machine has " << threads << (threads == 1 ? " thread\n" : " threads\n");
    return interrupted ? 3 : 0;
}

int study(const LaunchEnvironment& launch, const StudyOptions& options) {
    if (options.dry_run) return launch.rank == 0 ? dry_run(options) : 0;
    if (is_separate_world(launch)) return 2;
    Study study;
    FarmTask task;
    const LogOutput log_output = make_log_output(launch, options.farm);
    const Log log = make_log("treefarm", {}, log_output.console, log_output.verbosity);
    task.prepare = [&] {
        study = read_study_for(options);
        std::vector<std::string> warnings;
        warn_if_crowded(options.farm.threads, warnings);
        for (const std::string& warning : warnings)
            log->warn("{}", warning);
    };
    task.coordinate = [&](const RenderWorkers& workers) -> CoordinatorEnd {
        SeriesContext series = make_series({.command = options.command, .fingerprint = this_build()}, workers,
                                           log_output, log, launch.life);
        series.overwrite = options.overwrite;
        const StudyOutcome outcome = run_study(study, series);
        return {exit_code_of(outcome.state), outcome.lost_peers};
    };
    const int code = run_on_farm(launch, options.farm, log_output, task);
    if (code == 0 && launch.rank == 0) {
        const WrittenReport report = write_study_report(study.directory);
        for (const std::string& answer : report.answers)
            log->info("{}", answer);
        if (!report.warning.empty()) log->warn("{}", report.warning);
        log->info("report: {}", report.page.string());
    }
    return code;
}

/// Prints the page's path on standard output for scripts, and its summary for the user.
void tell(const WrittenReport& report) {
    for (const std::string& answer : report.answers)
        std::cerr << answer << "\n";
    if (!report.warning.empty()) std::cerr << "warning: " << report.warning << "\n";
    std::cout << report.page.string() << "\n";
}

/// Exports figures, into subfolders if there are several results.
void export_figures_of(const StudyResults& results, const ReportOptions& options, bool several) {
    if (options.figures.empty()) return;
    std::filesystem::path folder = options.figures;
    if (several) folder /= results.folder.filename();
    const ExportedFigures exported = export_figures(results, options.style, folder);
    std::cerr << exported.figures << " figures in " << folder.string()
              << (exported.with_pdf ? "" : "; no PDF: this gnuplot has no pdfcairo (install gnuplot-nox)") << "\n";
}

void report(ReportOptions& options) {
    if (!options.width.empty()) options.style.width_inches = figure_width(options.width);
    std::vector<std::filesystem::path> runs, studies;
    for (const std::string& folder : options.folders) {
        const bool is_run =
            !std::filesystem::exists(std::filesystem::path(folder) / kStudyFile) && is_run_folder(folder);
        (is_run ? runs : studies).emplace_back(folder);
    }
    const bool several = studies.size() + !runs.empty() > 1;
    for (const std::filesystem::path& folder : studies) {
        tell(write_study_report(folder));
        export_figures_of(read_study_results(folder), options, several);
    }
    if (!runs.empty()) {
        const StudyResults results = read_run_results(runs);
        tell(write_page(results,
                        options.output.empty() ? runs.front() / "report.html" : std::filesystem::path(options.output)));
        export_figures_of(results, options, several);
    }
    if (!options.prices.empty())
        write_price_list(studies, {options.benches.begin(), options.benches.end()}, options.prices);
}

}  // namespace

void add_report_command(CLI::App& app, const LaunchEnvironment& launch) {
    const auto options = std::make_shared<ReportOptions>();
    CLI::App* command = app.add_subcommand("report", "Writes the reports of studies, or one of single renders");
    command->add_option("folder", options->folders, "folders that treefarm study or treefarm render wrote")->required();
    add_text_option(*command, "-o,--output", options->output,
                    "the page of single renders (default: report.html in the folder of the first)");
    CLI::Option* exported = add_text_option(*command, "--export", options->figures,
                                            "also write the charts as SVG, PDF and CSV files into this folder");
    add_text_option(*command, "--width", options->width, "of exported charts: 3.3in (default), 84mm")->needs(exported);
    add_text_option(*command, "--font", options->style.font, "of exported charts (default: Helvetica)")
        ->needs(exported);
    CLI::Option* prices = add_text_option(*command, "--price-list", options->prices,
                                          "also write what each method costs and buys, as Markdown, to this file");
    add_texts_option(*command, "--bench", options->benches,
                     "in that file, also what this JSON file of a benchmark says")
        ->needs(prices);
    command->callback([options, launch] {
        if (launch.rank == 0) report(*options);
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
    CLI::Option* dry = command->add_flag("--dry-run", options->dry_run,
                                         "list the cells, which are done, and the time of the others; write nothing");
    add_seconds_option(*command, "--probe", options->probe_seconds,
                       "of a dry run: how long to render each scene and method for that (default: 1)")
        ->needs(dry);
    command->add_flag("--no-probe", options->no_probe, "of a dry run: render nothing for that")->needs(dry);
    command->footer(kExitCodesText);
    command->callback([options, launch, &exit_code] { exit_code = study(launch, *options); });
}

}  // namespace treefarm
