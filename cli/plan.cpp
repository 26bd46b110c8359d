// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>

#include "cli/commands.h"
#include "cli/estimator_choice.h"
#include "cli/option_values.h"
#include "cli/plan_answer.h"
#include "cli/plan_frames.h"
#include "cli/probe_here.h"
#include "cli/render.h"
#include "common/config/check_job.h"
#include "common/plan/effects/plan_text.h"
#include "coordinator/input/lint/lint.h"
#include "coordinator/shot/frames.h"

namespace treefarm {

namespace {

struct PlanOptions {
    RenderOptions render;
    bool json = false;
    bool lists = false;
    bool no_probe = false;
    std::optional<double> probe_seconds;

    bool asks() const {
        return render.budget.spp || render.budget.seconds || render.budget.error || !render.frames.empty();
    }
    double seconds() const { return probe_seconds.value_or(kProbeSeconds); }
};

/// Beginning of a plan: forecast and advice.
struct Findings {
    std::string answer;               ///< text
    nlohmann::ordered_json expected;  ///< null without a probe
};

void print(const PlanOptions& options, const RenderRequest& request, const Findings& found, std::ostream& out) {
    const EffectPlan& plan = request.content.plan;
    const std::string& scene = request.content.job.scene.file;
    if (!options.json) {
        out << found.answer << (options.lists ? plan_text(plan, scene) : plan_brief(plan, scene));
        if (!options.lists) out << "-v lists effects with reasons, kernels, and memory by use\n";
        return;
    }
    nlohmann::ordered_json json = nlohmann::ordered_json::parse(plan_json(plan, scene));
    if (!found.expected.is_null()) json["expected"] = found.expected;
    out << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << "\n";
}

/// Thrown when Ctrl-C ended a probe.
struct Interrupted {};

/// Probe of a request for the plan, of the film or a smaller one.
PlanAnswer probed(const PlanOptions& options, const Resolved& job, RenderRequest& on_film, double pixel_ratio) {
    Probe probe = probe_here(on_film, options.seconds(), options.render.farm.threads);
    if (probe.interrupted) throw Interrupted();
    return answer_by_probe(job, std::move(probe), pixel_ratio);
}

void tell_probes(const PlanOptions& options, const std::string& of) {
    if (!options.json) std::fprintf(stderr, "treefarm: probing %sfor %.3g s\n", of.c_str(), options.seconds());
}

/// Expectation by another estimator; nothing if it refuses the scene or job.
std::optional<Expectation> expected_by(const PlanOptions& options, RenderRequest request, const std::string& type,
                                       double pixel_ratio) {
    try {
        request.content.job.integrator.type = type;
        check_job(request.content.job);
        request.content.plan = plan_effects(request.content.scene, request.content.job);
    } catch (const InputError&) {
        return {};
    }
    tell_probes(options, type + " ");
    return probed(options, request.content.plan.job, request, pixel_ratio).expected;
}

Findings find(const PlanOptions& options, RenderRequest& request) {
    EffectPlan& plan = request.content.plan;
    const std::string own = plan.job.integrator.type;
    const EstimatorAdvice other = estimator_advice(request.content.scene, plan.job);
    const bool may_differ = other.type != own && (own == "path" || own == "bidirectional");
    if (!options.asks() || options.no_probe) {
        if (may_differ) plan.advice = untried_estimator_text(other, own);
        return {options.asks() ? "seconds and error are not known without a probe (leave --no-probe away)\n\n" : "",
                {}};
    }
    auto [on_film, pixel_ratio] = smaller_film(request);
    tell_probes(options, "");
    const PlanAnswer answer = probed(options, plan.job, on_film, pixel_ratio);
    if (may_differ)
        if (const auto by_other = expected_by(options, on_film, other.type, pixel_ratio))
            plan.advice = estimator_choice_text(other, own, times_as_fast(*by_other, answer.expected));
    return {answer_text(plan.job, answer), answer_json(answer)};
}

/// First, middle and last frame of a shot.
Findings find_frames(const PlanOptions& options, const std::vector<int>& frames) {
    if (options.no_probe)
        throw InputError(Location{"--frames", 0, 0}, "the time of frames is not known without a probe",
                         "leave --no-probe away");
    std::vector<ProbedFrame> all;
    for (const std::size_t index : frames_to_probe(frames.size())) {
        const RenderRequest request = read_request(frame_options(options.render, frames[index]));
        auto [on_film, pixel_ratio] = smaller_film(request);
        tell_probes(options, "frame " + std::to_string(frames[index]) + " ");
        const Resolved& job = request.content.plan.job;
        all.push_back({index, frames[index], job, probed(options, job, on_film, pixel_ratio)});
    }
    return {frames_text(all, frames.size()), frames_json(all, frames.size())};
}

int run_plan(const PlanOptions& options, std::ostream& out) try {
    std::vector<int> frames;
    if (!options.render.frames.empty()) frames = parse_frames(options.render.frames, Location{"--frames", 0, 0});
    RenderRequest request = read_request(frames.empty() ? options.render : frame_options(options.render, frames[0]));
    for (const Finding& cause : dark_causes(request.content.scene))
        request.content.plan.warnings.push_back(cause.sentence());
    print(options, request, frames.empty() ? find(options, request) : find_frames(options, frames), out);
    return 0;
} catch (const Interrupted&) {
    std::fprintf(stderr, "treefarm: interrupted: nothing is known yet\n");
    return 3;
}

}  // namespace

void add_plan_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto options = std::make_shared<PlanOptions>();
    RenderOptions& render = options->render;
    CLI::App* command = app.add_subcommand("plan", "Tells what a render would simulate, why, and what it costs");
    command->add_option("input", render.input, "Mitsuba scene (.xml) or job (.toml)")->required();
    command->add_flag("--json", options->json, "print JSON instead of text");
    command->add_flag("-v,--verbose", options->lists, "also list effects with reasons, kernels, and memory by use");
    add_samples_option(*command, render.budget.spp, "what seconds and error would these samples per pixel come to?");
    add_seconds_option(*command, "--seconds", render.budget.seconds, "what samples and error would this time come to?");
    add_error_option(*command, render.budget.error, "what samples and time would this error take? 0.05, or 5%");
    add_seconds_option(*command, "--probe", options->probe_seconds, "how long to render to answer that (default: 5)");
    command->add_flag("--no-probe", options->no_probe, "render nothing to answer that: no seconds and no error");
    add_text_option(
        *command, "--frames", render.frames,
        "1-24, 1-24x2 or 1,5,9: what would a shot of these frames take? The first, middle and last are probed");
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
