// SPDX-License-Identifier: Apache-2.0
#include "tests/support/local_render.h"

#include <optional>

#include "common/film/pass_film.h"
#include "common/plan/schedule/kernel.h"
#include "common/plan/schedule/learning.h"
#include "coordinator/passes/render_state.h"
#include "worker/registry.h"

namespace treefarm::test {
namespace {

Box3 guiding_bounds(const Scene& scene) {
    Box3 bounds = scene.bounds();
    bounds.extendBy(scene.camera.origin);
    return bounds;
}

}  // namespace

LocalRender render_locally(const Scene& scene, const Job& asked) {
    LocalRender run;
    const Resolved job = resolve(asked, scene);
    const PassChooser choose = passes_of(job);
    const RenderUnit render_unit = prepare(job, std::make_shared<const TraceScene>(scene, job));
    RenderState state = first_state(job, first_model(job, guiding_bounds(scene), 1.0f), scene.film.pixel_count());
    RenderHistory& history = state.history;
    std::optional<PassPlan> before;
    for (NextPass next = choose(history); next.pass;) {
        PassPlan pass = *next.pass;
        Decisions::apply(pass, history.decisions, false);
        pass.kernel = kernel_of(job, pass, facts_of(state.tree));
        state.tree.set_pass(pass.index);
        run.model = state.tree;
        const AnySampler guide(state.tree);
        AnyAccumulator accumulator(pass.index, guide, job.guiding.directional_filter, pass.learn_mixture);
        PassFilm film(scene.film.width, scene.film.height, pass.chunks);
        SplatSums splats(pass.layers.splats);
        UnitStats stats;
        UnitOutput output;
        for (const WorkUnit& unit : cut_pass(pass, scene.film.width, scene.film.height, job.farm.tile_size)) {
            output.begin(guide, pass.layers.splats);
            render_unit(pass, guide, unit, output);
            if (pass.layers.estimates) film.add(unit, output.pixels);
            splats.add(output.splats.summed(), output.splats.caps());
            stats.add(output.stats);
            if (pass.record) accumulator.commit(output.log);
        }
        run.stats.push_back(stats);
        run.splat_caps.add(splats.caps());
        std::vector<PixelEstimate> pixels = pass.layers.estimates ? film.pixels() : std::vector<PixelEstimate>();
        show(finished_pass(pass, before ? &*before : nullptr,
                           develop(std::move(pixels), splats, pass.splatting_paths(), pass.splatting_chains())),
             job, state.films);
        before = pass;
        run.image = combine_passes(state.films, job.guiding.combination, job.guides);
        const double seconds = 1e-3 * pass.spp;
        PassFacts facts;
        facts.spp = pass.spp;
        facts.spp_before = pass.first_sample;
        const PassVariance variance = pass_variance(state.films.back().pixels);
        facts.mse_of_sample = variance.mse_of_sample;
        facts.stuv_trimmed = variance.stuv_trimmed;
        facts.collect_seconds = seconds;
        facts.record = pass.record;
        facts.next_event = pass.next_event;
        history.passes.push_back(facts);
        history.budget = next.memory;
        history.seconds += seconds;
        history.error = estimate_error(run.image, job.sampler.seed);
        run.states.push_back(history);
        PassReport report;
        report.plan = pass;
        report.stats = stats;
        judge(state, job, run.image, static_cast<std::size_t>(scene.film.width), stats.decided, report);
        next = choose(history);
        if (pass.record && next.pass) learn(state, job, pass, next.pass, accumulator.take(), report);
        run.plans.push_back(pass);
        run.reports.push_back(std::move(report));
    }
    run.passes = std::move(state.films);
    return run;
}

}  // namespace treefarm::test
