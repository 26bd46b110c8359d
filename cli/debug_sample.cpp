// SPDX-License-Identifier: Apache-2.0
#include "cli/debug_sample.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <thread>
#include <utility>

#include "cli/launch.h"
#include "common/base/host.h"
#include "common/comm/in_process_channel.h"
#include "common/plan/kernel.h"
#include "common/plan/learning.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/pass_loop.h"
#include "worker/integrators/registry.h"
#include "worker/tools/describe_sample.h"
#include "worker/worker_loop.h"

namespace treefarm {

namespace {

const Location kHere{"--debug-sample", 0, 0};

/// Whether the checkpoint is one of these passes: their kernels may not be known yet.
bool begins(const std::vector<PassPlan>& plans, const RenderState& state) {
    const auto alike = [](const PassReport& done, PassPlan plan) {
        plan.kernel = done.plan.kernel;
        return done.plan == plan;
    };
    return state.reports.size() <= plans.size() &&
           std::equal(state.reports.begin(), state.reports.end(), plans.begin(), alike);
}

/// The state after the pass before, as far as a checkpoint knows it; otherwise that before any pass.
RenderState nearest_state(const RenderRequest& request, const std::vector<PassPlan>& plans, std::uint32_t pass) {
    if (request.resumed && begins(plans, request.resumed->state)) {
        RenderState& state = request.resumed->state;
        // Unless the pass taught it anything: of next event an unguided one does.
        const PassPlan* const last = state.reports.empty() ? nullptr : &state.reports.back().plan;
        const bool has_its_tree = last && state.reports.size() == pass + 1 && !last->record &&
                                  (last->guided || !request.plan.job.decides_next_event);
        if (state.reports.size() <= pass || has_its_tree) return std::move(state);
    }
    return starting_state(request);
}

/// The tree of a pass, which may decide on next event alone, learned by rendering the passes before it, but for those
/// that a checkpoint knows.
AnyModel learn_tree(const RenderRequest& request, const std::vector<PassPlan>& plans, std::uint32_t pass) {
    RenderState state = nearest_state(request, plans, pass);
    const bool learns = request.plan.job.guides || request.plan.job.decides_next_event;
    if (state.reports.size() >= pass || !learns) return std::move(state.tree);
    const Log log = make_log("treefarm", {}, request.console, Verbosity::quiet);
    auto channels = make_in_process_channels(2);
    std::thread worker([&] {
        WorkerSettings settings;
        settings.threads = affinity_threads();
        settings.host = this_host().name;
        settings.fingerprint = request.fingerprint.hash();
        run_worker(*channels[1], settings, make_renderer, log);
    });
    const auto send_away = [&] {
        dismiss_workers(*channels[0], {}, FarmLimits().dismiss);
        worker.join();
    };
    AnyModel tree;
    try {
        Farm farm(*channels[0], request.plan.job, encode_scene(request.scene), request.fingerprint.hash(), log);
        bool enough = false;
        PassHooks hooks;
        hooks.interrupted = [&] { return enough; };
        hooks.on_pass = [&](const PassReport& report, const CombinedImage&) { enough = report.plan.index + 1 == pass; };
        farm.gather({[] { return false; }});
        const Film& film = request.scene.film;
        farm.allow_negative(film.is_signed());
        tree =
            run_passes(farm, request.plan.job, listed_passes(plans), std::move(state), film.width, film.height, hooks)
                .tree;
    } catch (...) {
        send_away();
        throw;
    }
    send_away();
    return tree;
}

/// The tree that guides a pass, and the pass with the kernel that goes with it.
std::pair<AnyModel, PassPlan> tree_and_pass(const RenderRequest& request, const std::vector<PassPlan>& plans,
                                            std::uint32_t index) {
    AnyModel tree = learn_tree(request, plans, index);
    PassPlan pass = plans[index];
    pass.kernel = kernel_of(request.plan.job, pass, facts_of(tree));
    return {std::move(tree), pass};
}

/// As many numbers, separated by commas; InputError if the text is not that.
std::vector<std::uint32_t> parse_numbers(const std::string& text, std::size_t count) {
    std::vector<std::uint32_t> values(count);
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t k = 0; k < count; ++k) {
        const auto [next, error] = std::from_chars(at, end, values[k]);
        const bool whole = error == std::errc() && (k + 1 < count ? next != end && *next == ',' : next == end);
        if (!whole || values[k] > 1u << 30)
            throw InputError(kHere, "\"" + text + "\" names neither a sample nor a tile",
                             "write pass,x,y,sample, like 3,120,64,0, or pass,x0,y0,x1,y1,chunk");
        at = next + 1;
    }
    return values;
}

std::vector<PassPlan> known_passes(const RenderRequest& request) {
    if (request.schedule.empty() && has_open_budget(request.plan.job))
        throw InputError(kHere, "the passes of this job depend on clock or error",
                         "add --schedule with the schedule.toml of the run");
    return request.schedule.empty() ? plan_passes(request.plan.job) : request.schedule;
}

[[noreturn]] void refuse_location(const RenderRequest& request, const std::vector<PassPlan>& plans, const char* what) {
    const Film& film = request.scene.film;
    throw InputError(kHere, std::string("there is no such ") + what,
                     "the image has " + std::to_string(film.width) + " x " + std::to_string(film.height) +
                         " pixels and " + std::to_string(plans.size()) + " passes");
}

}  // namespace

SampleName parse_sample_name(const std::string& text) {
    const std::vector<std::uint32_t> values = parse_numbers(text, 4);
    return {values[0], static_cast<int>(values[1]), static_cast<int>(values[2]), values[3]};
}

int debug_sample(const RenderRequest& request, const SampleName& name) {
    const std::string& type = request.plan.job.integrator.type;
    if (type != Job().integrator.type)
        throw InputError(kHere, "the estimator \"" + type + "\" has no paths that can be described",
                         "add --set integrator.type=" + Job().integrator.type);
    const std::vector<PassPlan> plans = known_passes(request);
    const Film& film = request.scene.film;
    if (name.pass >= plans.size() || name.x >= film.width || name.y >= film.height ||
        name.sample >= plans[name.pass].spp)
        refuse_location(request, plans, "sample");
    const auto [tree, pass] = tree_and_pass(request, plans, name.pass);
    const TraceScene scene(request.scene, request.job);
    const std::string text =
        describe_sample(scene, request.plan.job, pass, AnySampler(tree), name.x, name.y, name.sample);
    std::fputs(text.c_str(), stdout);
    return 0;
}

bool names_tile(const std::string& text) {
    return std::count(text.begin(), text.end(), ',') == 5;
}

int debug_tile(const RenderRequest& request, const std::string& text) {
    const std::vector<std::uint32_t> n = parse_numbers(text, 6);
    const std::vector<PassPlan> plans = known_passes(request);
    const auto width = static_cast<std::uint32_t>(request.scene.film.width),
               height = static_cast<std::uint32_t>(request.scene.film.height);
    if (n[0] >= plans.size() || n[1] >= n[3] || n[2] >= n[4] || n[3] > width || n[4] > height ||
        n[5] >= plans[n[0]].chunks)
        refuse_location(request, plans, "tile");
    const auto [tree, pass] = tree_and_pass(request, plans, n[0]);
    const RenderUnit render = make_renderer(encode_scene(request.scene), request.plan.job);
    const AnySampler guide(tree);
    UnitOutput output;
    output.begin(guide.regions().distribution_count(), pass.layers.splats);
    const auto edge = [](std::uint32_t value) { return static_cast<std::uint16_t>(value); };
    render(pass, guide, {n[0], edge(n[1]), edge(n[2]), edge(n[3]), edge(n[4]), n[5]}, output);
    fmt::print("pass {} pixels ({}, {}) to below ({}, {}): {} paths, {} rays, {:.3f} s\n", n[0], n[1], n[2], n[3], n[4],
               output.stats.paths, output.stats.rays + output.stats.shadow_rays, output.stats.trace_seconds);
    return 0;
}

}  // namespace treefarm
