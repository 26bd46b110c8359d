// SPDX-License-Identifier: Apache-2.0
#include "tests/support/local_render.h"

#include <optional>

#include "common/film/guiding_probe.h"
#include "common/film/pass_film.h"
#include "common/plan/kernel.h"
#include "common/plan/learning.h"
#include "worker/integrators/registry.h"

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
    const bool guided = job.guides;
    const RenderUnit render_unit = prepare(job, std::make_shared<const TraceScene>(scene, job));
    run.model = first_model(job, guiding_bounds(scene), 1.0f);
    AnyLearner learner;
    RenderHistory state;
    GuidingProbe probe;
    ProbesSetAside set_aside;
    std::optional<PassPlan> before;
    for (NextPass next = choose(state); next.pass;) {
        PassPlan pass = *next.pass;
        set_emission(pass, job, state);
        pass.kernel = kernel_of(job, pass, facts_of(run.model));
        run.model.set_pass(pass.index);
        const AnySampler guide(run.model);
        AnyAccumulator accumulator(pass.index, guide, job.guiding.directional_filter, pass.learn_mixture);
        PassFilm film(scene.film.width, scene.film.height, pass.chunks);
        SplatSums splats(pass.layers.splats);
        TraceStats stats;
        UnitOutput output;
        for (const WorkUnit& unit : cut_pass(pass, scene.film.width, scene.film.height, job.farm.tile_size)) {
            output.begin(pass.record ? guide.regions().distribution_count() : 0, pass.layers.splats);
            render_unit(pass, guide, unit, output);
            if (pass.layers.estimates) film.add(unit, output.pixels);
            splats.add(output.splats.summed(), output.splats.caps());
            stats.add(output.stats);
            if (pass.record)
                accumulator.commit(output.log.records, output.log.counts, output.log.caps, output.log.next_event);
        }
        run.stats.push_back(stats);
        run.splat_caps.add(splats.caps());
        std::vector<PixelEstimate> pixels = pass.layers.estimates ? film.pixels() : std::vector<PixelEstimate>();
        PassResult shown =
            finished_pass(pass, before ? &*before : nullptr,
                          develop(std::move(pixels), splats, pass.splatting_paths(), pass.splatting_chains()));
        before = pass;
        if (stats.probe_paths > 0) {
            probe.add(shown.pixels, stats, pass.index);
            if (!shows_last_tree_only(job)) set_aside.take_out(shown.pixels, pass.index, run.passes.size());
        }
        show(std::move(shown), job, run.passes);
        run.image = combine_passes(run.passes, job.guiding.combination, guided);
        const double seconds = 1e-3 * pass.spp;
        PassFacts facts;
        facts.spp = pass.spp;
        facts.spp_before = pass.first_sample;
        const PassVariance variance = pass_variance(run.passes.back().pixels);
        facts.mse_of_sample = variance.mse_of_sample;
        facts.stuv_trimmed = variance.stuv_trimmed;
        facts.collect_seconds = seconds;
        facts.record = pass.record;
        facts.next_event = pass.next_event;
        state.passes.push_back(facts);
        state.budget = next.memory;
        state.seconds += seconds;
        state.error = estimate_error(run.image, job.sampler.seed);
        run.states.push_back(state);
        if (pass.guided && pass.record) {
            const GuidingGain gain = probe.gain(run.passes.back().pixels, stats, pass.index, run.image.mean,
                                                static_cast<std::size_t>(scene.film.width));
            run.guiding_gains.push_back(gain.all);
            if (state.guiding == Guiding::open) state.guiding = judge_guiding(pass, gain);
            if (state.guiding == Guiding::loses) set_aside.put_back(run.passes);
        }
        if (!splitting_may_pay(pass, splitting_gain(stats))) state.splitting = false;
        if (!light_subpaths_may_pay(pass, light_subpath_gain(stats))) state.light_subpaths = false;
        state.emission.add(stats.emission);
        run.plans.push_back(pass);
        next = choose(state);
        if (!pass.record || !next.pass) continue;
        RefineReport report;
        run.model = learner.learn(run.model, accumulator.take(), refine_settings(job, pass, *next.pass),
                                  pass.learn_mixture, report);
    }
    return run;
}

}  // namespace treefarm::test
