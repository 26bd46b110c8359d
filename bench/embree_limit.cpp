// SPDX-License-Identifier: Apache-2.0
// Efficiency of whole renders relative to Embree: paths of a scene are traced by the renderer, then exactly their rays
// by a bare loop over Embree, in turns, on one thread. The renderer's additional time is printed per vertex. There are
// two bare loops: one intersects rays one by one, as Embree's examples do ("bare"), the other intersects packets and
// many shadow rays together, as the renderer does ("best bare").
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <span>

#include "common/base/error.h"
#include "common/base/timer.h"
#include "common/config/job_reader.h"
#include "common/guiding/any_guide.h"
#include "common/plan/schedule/kernel.h"
#include "common/plan/schedule/learning.h"
#include "coordinator/input/load.h"
#include "worker/geometry/embree_api.h"
#include "worker/guides/walks.h"
#include "worker/integrators/path/path_kernel.h"
#include "worker/integrators/path/tile_renderer.h"

namespace treefarm {
namespace {

/// Observer that stores the rays of a path.
struct RayObserver : NoObserver {
    std::vector<Ray>* rays = nullptr;
    std::vector<Ray>* shadow_rays = nullptr;
    void ray(const Ray& r) { rays->push_back(r); }
    void shadow(const Ray& r) {
        if (r.length > 0.0f) shadow_rays->push_back(r);
    }
};

struct Options {
    std::string scene;
    std::vector<std::string> set;
    std::uint32_t train = 31;
    std::uint32_t spp = 32;
    int width = 0, height = 0;
    int repetitions = 5;
    std::vector<std::string> modes{};
};

/// A kind of render, with its times: the renderer's, and the bare loop's for the same rays.
struct Mode {
    const char* name;
    bool guided, next_event, record;
    std::vector<Ray> rays, shadow_rays;
    UnitStats stats;
    std::size_t log_records = 0;  ///< of directions and of emitters, without those that taught nothing
    std::vector<double> render_seconds{}, bare_seconds{}, best_bare_seconds{}, splat_seconds{};
};

class Limit {
  public:
    Limit(LoadedScene loaded, const Options& options)
        : job_(make_job(loaded, options)),
          bounds_(loaded.scene.bounds()),
          facts_(facts_of(loaded.scene)),
          resolved_(resolve(job_, facts_)),
          first_(first_model(resolved_, bounds_, loaded.scene.radiance_scale())),
          scene_(std::move(loaded.scene), resolved_),
          spp_(options.spp),
          guide_(train()),
          untrained_(first_) {}

    const AnySampler& guide() const { return guide_; }

    void collect(Mode& mode) const {
        if (scene_.plainly_diffuse())
            mode.guided ? collect_with<SdTreeWalk<false>, DiffuseSurface, true>(mode)
                        : collect_with<NoGuide, DiffuseSurface, false>(mode);
        else
            facts_of(guide(mode)).has_views&& mode.guided ? collect_with<SdTreeWalk<true>, GeneralSurface, true>(mode)
            : mode.guided                                 ? collect_with<SdTreeWalk<false>, GeneralSurface, true>(mode)
                                                          : collect_with<NoGuide, GeneralSurface, false>(mode);
    }

    void measure(Mode& mode) {
        mode.stats = {};
        const auto seconds = [](const auto& work) {
            const double start = thread_cpu_seconds();
            work();
            return thread_cpu_seconds() - start;
        };
        AnyAccumulator sums(9, guide(mode), job_.guiding.directional_filter, true);
        double splat = 0;
        mode.log_records = 0;
        const auto learn = [&](AnyLog& log) {
            mode.log_records += log.of<SdTreeGuide>().records.size();
            splat += seconds([&] { sums.commit(log); });
        };
        const double both = seconds([&] { render(pass(mode), job(mode), guide(mode), mode.stats, learn); });
        mode.render_seconds.push_back(both - splat);
        mode.splat_seconds.push_back(splat);
        mode.bare_seconds.push_back(seconds([&] { trace_bare(mode); }));
        mode.best_bare_seconds.push_back(seconds([&] { trace_together(mode); }));
    }

  private:
    static Job make_job(const LoadedScene& loaded, const Options& options) {
        Job job;
        std::vector<Setting> layer;
        for (const std::string& argument : options.set)
            layer.push_back(parse_set_argument(argument));
        apply_layer(job, scene_layer(loaded.settings, {layer}));
        apply_layer(job, layer);
        job.budget.spp = options.train;
        return job;
    }

    Resolved job(const Mode& mode) const {
        Job job = job_;
        if (!mode.guided && !mode.record) job.guiding.type = GuidingType::none;
        return resolve(job, facts_);
    }

    const AnySampler& guide(const Mode& mode) const { return mode.guided ? guide_ : untrained_; }

    PassPlan pass(const Mode& mode) const {
        PassPlan pass;
        pass.index = 9;
        pass.spp = spp_;
        pass.blocks_per_unit = 1u << 20;
        pass.first_sample = 1u << 20;
        pass.next_event = mode.next_event;
        pass.record = mode.record;
        pass.learn_mixture = mode.record;
        pass.guided = job(mode).guides;
        return pass;
    }

    /// Renders unit by unit, as workers do; `learn` receives each unit's records.
    template <class Learn>
    void render(PassPlan pass, const Resolved& job, const AnySampler& guide, UnitStats& stats, Learn learn) {
        pass.kernel = kernel_of(job, pass, facts_of(guide));
        const Film& film = scene_.film();
        for (const WorkUnit& unit : cut_pass(pass, film.width, film.height, job.farm.tile_size)) {
            render_unit(scene_, job, pass, guide, unit, pixels_, log_, stats);
            if (pass.record) learn(log_);
        }
    }

    /// Tree after the job's passes.
    AnyModel train() {
        AnyModel tree = first_;
        AnyLearner learner;
        const std::vector<PassPlan> plans = plan_passes(resolved_);
        for (std::size_t k = 0; k < plans.size(); ++k) {
            PassPlan plan = plans[k];
            plan.record = true;
            plan.chunks = 1;
            plan.blocks_per_unit = 1u << 20;
            const AnySampler guide(tree);
            AnyAccumulator sums(plan.index, guide, job_.guiding.directional_filter, plan.learn_mixture);
            UnitStats stats;
            render(plan, resolved_, guide, stats, [&](AnyLog& log) { sums.commit(log); });
            RefineReport report;
            const PassPlan& coming = plans[std::min(k + 1, plans.size() - 1)];
            tree =
                learner.learn(tree, sums.take(), refine_settings(resolved_, plan, coming), plan.learn_mixture, report);
        }
        return tree;
    }

    template <GuideWalk G, class Surface, bool kGuided>
    void collect_with(Mode& mode) const {
        UnitStats stats;
        const Resolved mode_job = job(mode);
        const auto& sampler = guide(mode).get<typename G::Sampler>();
        PathKernel<G, Surface, kGuided, false, RayObserver> kernel(
            scene_, sampler, PathSettings(scene_, mode_job, pass(mode), sampler), stats);
        kernel.observer().rays = &mode.rays;
        kernel.observer().shadow_rays = &mode.shadow_rays;
        for (int y = 0; y < scene_.film().height; ++y)
            for (int x = 0; x < scene_.film().width; ++x) {
                PathKey path{job_.sampler.seed, static_cast<std::uint32_t>(y * scene_.film().width + x), 0};
                for (std::uint32_t sample = 0; sample < spp_;) {
                    kernel.clear();
                    for (; !kernel.full() && sample < spp_; ++sample) {
                        path.sample = pass(mode).first_sample + sample;
                        kernel.add(path, scene_.camera().generate(x, y, path));
                    }
                    kernel.trace();
                }
            }
    }

    /// RTCRay set field by field, as in Embree's own examples.
    static RTCRay by_fields(const Ray& r) {
        return {r.origin.x, r.origin.y, r.origin.z, 0.0f, r.direction.x, r.direction.y, r.direction.z, 0.0f,
                r.length,   ~0u,        0,          0};
    }

    void trace_bare(const Mode& mode) const {
        EmbreeRays rays;
        for (const Ray& ray : mode.rays) {
            RTCRayHit query;
            query.ray = by_fields(ray);
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
            rays.intersect(scene_.geometry().handle(), query);
        }
        for (const Ray& ray : mode.shadow_rays) {
            RTCRay query = by_fields(ray);
            rays.occluded(scene_.geometry().handle(), query);
        }
    }

    /// Traces as many rays together as the renderer may have.
    void trace_together(const Mode& mode) const {
        constexpr std::size_t kMost = EmbreeScene::kMostTogether;
        std::array<EmbreeScene::EmbreeHit, kMost> embree_hits;
        std::array<bool, kMost> found;
        std::array<EmbreeScene::Query, kMost> queries;
        const auto in_parts = [](std::span<const Ray> rays, const auto& trace) {
            while (!rays.empty()) {
                const std::size_t part = std::min(rays.size(), EmbreeScene::kMostTogether);
                trace(rays.first(part));
                rays = rays.subspan(part);
            }
        };
        in_parts(mode.rays, [&](std::span<const Ray> rays) {
            for (std::size_t i = 0; i < rays.size(); ++i)
                queries[i] = {&rays[i], &embree_hits[i], &found[i]};
            scene_.geometry().intersect({queries.data(), rays.size()});
        });
        in_parts(mode.shadow_rays, [&](std::span<const Ray> rays) { scene_.geometry().occluded(rays, found.data()); });
    }

    Job job_;
    Box3 bounds_;
    SceneFacts facts_;
    Resolved resolved_;
    AnyModel first_;
    TraceScene scene_;
    std::uint32_t spp_;
    std::vector<PixelEstimate> pixels_;
    AnyLog log_;
    AnySampler guide_, untrained_;
};

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void print(const Mode& mode) {
    const auto ratio = [&](const std::vector<double>& seconds) {
        std::vector<double> ratios;
        for (std::size_t i = 0; i < seconds.size(); ++i)
            ratios.push_back(seconds[i] / mode.render_seconds[i]);
        return median(ratios);
    };
    const auto rays = static_cast<double>(mode.rays.size() + mode.shadow_rays.size());
    const double render = median(mode.render_seconds), bare = median(mode.bare_seconds);
    const auto vertices = static_cast<double>(mode.stats.vertices);
    std::printf("| %-29s | %5.2f | %7.1f | %7.1f | %.3f | %7.1f | %.3f | %7.1f |", mode.name,
                rays / double(mode.stats.paths), 1e9 * render / rays, 1e9 * bare / rays, ratio(mode.bare_seconds),
                1e9 * median(mode.best_bare_seconds) / rays, ratio(mode.best_bare_seconds),
                1e9 * (render - bare) / vertices);
    if (mode.record)
        std::printf(" %5.1f |\n", 1e9 * median(mode.splat_seconds) / static_cast<double>(mode.log_records));
    else
        std::printf("       |\n");
}

void run(const Options& options) {
    Limit limit(load_scene(options.scene, {}, false, options.width, options.height), options);
    std::printf("%s, tree of %u regions, %.1f MB\n\n", options.scene.c_str(),
                limit.guide().get<SdTreeSampler>().region_count(),
                1e-6 * static_cast<double>(limit.guide().get<SdTreeSampler>().bytes()));
    std::vector<Mode> modes = {{"path", false, false, false, {}, {}, {}},
                               {"path, next event", false, true, false, {}, {}, {}},
                               {"guided", true, false, false, {}, {}, {}},
                               {"guided, next event", true, true, false, {}, {}, {}},
                               {"guided, recording", true, false, true, {}, {}, {}},
                               {"guided, recording, next event", true, true, true, {}, {}, {}}};
    std::puts(
        "| mode                          | rays per path | ns per ray | bare | ratio | best bare | ratio | "
        "rest, ns per vertex | splat, ns per record |");
    std::puts("|---|---|---|---|---|---|---|---|---|");
    const auto wanted = [&](const char* name) {
        return options.modes.empty() || std::count(options.modes.begin(), options.modes.end(), name) > 0;
    };
    for (Mode& mode : modes) {
        if (!wanted(mode.name)) continue;
        limit.collect(mode);
        for (int i = 0; i < options.repetitions; ++i)
            limit.measure(mode);
        print(mode);
        std::fflush(stdout);
        mode.rays = mode.shadow_rays = {};
    }
}

}  // namespace
}  // namespace treefarm

int main(int argc, char** argv) {
    CLI::App app("renders against a bare loop over Embree with the same rays, on one thread");
    treefarm::Options options;
    app.add_option("scene", options.scene, "Mitsuba scene")->required();
    app.add_option("--set", options.set, "key=value of the job")->allow_extra_args(false);
    app.add_option("--train", options.train, "samples per pixel that the tree learns from")->capture_default_str();
    app.add_option("--spp", options.spp, "samples per pixel that are measured")->capture_default_str();
    app.add_option("--width", options.width, "of the image, instead of the scene's");
    app.add_option("--height", options.height, "of the image, instead of the scene's");
    app.add_option("--mode", options.modes, "of the table's first column, these alone")->allow_extra_args(false);
    app.add_option("--repetitions", options.repetitions, "turns; medians are printed")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    try {
        treefarm::run(options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "embree_limit: %s\n", error.what());
        return 1;
    }
}
