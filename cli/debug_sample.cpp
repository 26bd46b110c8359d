// SPDX-License-Identifier: Apache-2.0
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <charconv>
#include <cstdio>

#include "cli/render.h"
#include "coordinator/render/passes_alone.h"
#include "worker/registry.h"
#include "worker/tools/describe_sample.h"

namespace treefarm {

namespace {

const Location kHere{"--debug-sample", 0, 0};

/// Numbers separated by commas, `count` of them, the first one a pass counted from 1, returned as an index. Throws
/// InputError for other texts.
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
    if (values[0] == 0) throw InputError(kHere, "there is no pass 0", "passes count from 1, as in a render's messages");
    --values[0];
    return values;
}

std::vector<PassPlan> passes_or_refuse(const RenderRequest& request) {
    std::vector<PassPlan> plans = known_passes(request);
    if (plans.empty())
        throw InputError(kHere, "the passes of this job depend on clock or error",
                         "add --schedule with the schedule.toml of the run");
    return plans;
}

[[noreturn]] void refuse_location(const RenderRequest& request, const std::vector<PassPlan>& plans, const char* what) {
    const Film& film = request.content.scene.film;
    throw InputError(kHere, std::string("there is no such ") + what,
                     "the image has " + std::to_string(film.width) + " x " + std::to_string(film.height) +
                         " pixels and " + std::to_string(plans.size()) + " passes");
}

void describe(const RenderRequest& request, const std::string& name, const TellMessage& tell) {
    const std::vector<std::uint32_t> n = parse_numbers(name, 4);
    const Resolved& job = request.content.plan.job;
    if (job.integrator.type != Job().integrator.type)
        throw InputError(kHere, "the estimator \"" + job.integrator.type + "\" has no paths that can be described",
                         "add --set integrator.type=" + Job().integrator.type);
    const std::vector<PassPlan> plans = passes_or_refuse(request);
    const Film& film = request.content.scene.film;
    const int x = static_cast<int>(n[1]), y = static_cast<int>(n[2]);
    if (n[0] >= plans.size() || x >= film.width || y >= film.height || n[3] >= plans[n[0]].spp)
        refuse_location(request, plans, "sample");
    const auto [tree, pass] = model_and_pass(request, plans, n[0], tell);
    const TraceScene scene(request.content.scene, job);
    std::fputs(describe_sample(scene, job, pass, AnySampler(tree), x, y, n[3]).c_str(), stdout);
}

void trace_tile(const RenderRequest& request, const std::string& name, const TellMessage& tell) {
    const std::vector<std::uint32_t> n = parse_numbers(name, 6);
    const std::vector<PassPlan> plans = passes_or_refuse(request);
    const auto width = static_cast<std::uint32_t>(request.content.scene.film.width),
               height = static_cast<std::uint32_t>(request.content.scene.film.height);
    if (n[0] >= plans.size() || n[1] >= n[3] || n[2] >= n[4] || n[3] > width || n[4] > height ||
        n[5] >= plans[n[0]].chunks)
        refuse_location(request, plans, "tile");
    const auto [tree, pass] = model_and_pass(request, plans, n[0], tell);
    const RenderUnit render = make_renderer(request.content.scene, request.content.plan.job);
    const AnySampler guide(tree);
    UnitOutput output;
    output.begin(guide, pass.layers.splats);
    const auto edge = [](std::uint32_t value) { return static_cast<std::uint16_t>(value); };
    render(pass, guide, {n[0], edge(n[1]), edge(n[2]), edge(n[3]), edge(n[4]), n[5]}, output);
    fmt::print("pass {} pixels ({}, {}) to below ({}, {}): {} paths, {} rays, {:.3f} s\n", n[0] + 1, n[1], n[2], n[3],
               n[4], output.stats.paths, output.stats.rays + output.stats.shadow_rays, output.stats.trace_seconds);
}

}  // namespace

void debug_sample(const RenderRequest& request, const std::string& name, const TellMessage& tell) {
    const bool is_tile = std::count(name.begin(), name.end(), ',') == 5;
    is_tile ? trace_tile(request, name, tell) : describe(request, name, tell);
}

}  // namespace treefarm
