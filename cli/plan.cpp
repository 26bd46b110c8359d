// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "cli/commands.h"
#include "cli/option_values.h"
#include "cli/plan_answer.h"
#include "cli/render.h"
#include "common/base/host.h"
#include "common/base/interrupt.h"
#include "common/plan/effects/plan_text.h"
#include "coordinator/input/lint/estimator_advice.h"
#include "coordinator/input/lint/lint.h"

namespace treefarm {

namespace {

struct PlanOptions {
    RenderOptions render;
    bool json = false;
    bool no_probe = false;
    std::optional<double> probe_seconds;

    bool asks() const { return render.budget.spp || render.budget.seconds || render.budget.error; }
};

/// Number of pixels of a probe of a larger film: noise per pixel hardly depends on it, time does.
constexpr double kProbePixels = 1 << 17;

/// Request on a smaller film, with the ratio of the numbers of pixels.
std::pair<RenderRequest, double> smaller_request(const PlanOptions& options, const RenderRequest& whole) {
    const double width = whole.content.scene.film.width, height = whole.content.scene.film.height;
    const double scale = std::sqrt(kProbePixels / (width * height));
    if (scale >= 1) return {whole, 1.0};
    RenderOptions smaller = options.render;
    const auto pixels = [&](double side) { return std::to_string(static_cast<int>(std::ceil(scale * side))); };
    // A job's size is that of the whole film.
    smaller.set.push_back("image.width=" + pixels(whole.content.scene.film.whole_width()));
    smaller.set.push_back("image.height=" + pixels(whole.content.scene.film.whole_height()));
    RenderInput input = render_input(smaller);
    input.holds_to_scene = false;  // its film is another
    RenderRequest request = read_request(input, whole.origin);
    const double ratio =
        width * height / (static_cast<double>(request.content.scene.film.width) * request.content.scene.film.height);
    return {std::move(request), ratio};
}

/// The probe by so many threads of this process.
Probe probe_here(RenderRequest& request, double seconds, unsigned threads) {
    const LogOutput log_output = errors_only();
    ignore_broken_pipes();
    InterruptWatch watch;
    request.workers.local = local_worker(threads, log_output);
    request.workers.stop = [&] { return watch.interrupted(); };
    Probe probe = run_probe(request, seconds, console_messages("treefarm", log_output.console, log_output.verbosity));
    probe.threads = threads > 0 ? threads : affinity_threads();
    return probe;
}

void print(const PlanOptions& options, const RenderRequest& request, const PlanAnswer* answer, std::ostream& out) {
    const std::string& scene = request.content.job.scene.file;
    if (!options.json) {
        if (answer != nullptr)
            out << answer_text(request.content.plan.job, *answer);
        else if (options.asks())
            out << "seconds and error are not known without a probe (leave --no-probe away)\n\n";
        out << plan_text(request.content.plan, scene);
        return;
    }
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(plan_json(request.content.plan, scene));
    if (answer != nullptr) json["expected"] = answer_json(*answer);
    out << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
}

int run_plan(const PlanOptions& options, std::ostream& out) {
    RenderRequest request = read_request(options.render);
    for (const Finding& cause : dark_causes(request.content.scene))
        request.content.plan.warnings.push_back(cause.sentence());
    request.content.plan.advice = estimator_advice(request.content.scene, request.content.plan.job);
    if (!options.asks() || options.no_probe) {
        print(options, request, nullptr, out);
        return 0;
    }
    auto [probed, pixel_ratio] = smaller_request(options, request);
    const double seconds = options.probe_seconds.value_or(kProbeSeconds);
    if (!options.json) std::fprintf(stderr, "treefarm: probing for %.3g s\n", seconds);
    Probe probe = probe_here(probed, seconds, options.render.farm.threads);
    if (probe.interrupted) {
        std::fprintf(stderr, "treefarm: interrupted: nothing is known yet\n");
        return 3;
    }
    const PlanAnswer answer = answer_by_probe(request.content.plan.job, std::move(probe), pixel_ratio);
    print(options, request, &answer, out);
    return 0;
}

}  // namespace

void add_plan_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto options = std::make_shared<PlanOptions>();
    RenderOptions& render = options->render;
    CLI::App* command = app.add_subcommand("plan", "Tells what a render would simulate, why, and what it costs");
    command->add_option("input", render.input, "Mitsuba scene (.xml) or job (.toml)")->required();
    command->add_flag("--json", options->json, "print JSON instead of a table");
    add_samples_option(*command, render.budget.spp, "what seconds and error would these samples per pixel come to?");
    add_seconds_option(*command, "--seconds", render.budget.seconds, "what samples and error would this time come to?");
    add_error_option(*command, render.budget.error, "what samples and time would this error take? 0.05, or 5%");
    add_seconds_option(*command, "--probe", options->probe_seconds, "how long to render to answer that (default: 5)");
    command->add_flag("--no-probe", options->no_probe, "render nothing to answer that: no seconds and no error");
    add_threads_option(*command, render.farm.threads, "tracing threads of the probe (default: the processors)");
    add_texts_option(*command, "--set", render.set, "key=value: sets a key of the job (treefarm keys lists them)");
    add_texts_option(*command, "-D", render.defines, "name=value: gives $name in the scene a value");
    add_text_option(*command, "--sensor", render.sensor, "which of several sensors, by number from 0 on or by id");
    command->add_flag("--lenient", render.lenient, "replace unknown elements of the scene instead of refusing them");
    command->callback([options, launch, &exit_code] {
        if (launch.rank == 0) exit_code = run_plan(*options, std::cout);  // under mpirun one process is enough
    });
}

}  // namespace treefarm
