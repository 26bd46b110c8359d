// SPDX-License-Identifier: Apache-2.0
// Cost of a whole path: camera, intersection, scattering, next event, guiding, recording, film.
#include <benchmark/benchmark.h>

#include "common/guiding/sd_tree/refine.h"
#include "common/guiding/statistics/cell_accumulator.h"
#include "tests/support/material_scenes.h"
#include "tests/support/resolved.h"
#include "worker/integrators/path/tile_renderer.h"

namespace treefarm {
namespace {

constexpr int kSize = 64;

PassPlan make_pass(std::uint32_t index, std::uint32_t spp, bool next_event, bool record) {
    PassPlan pass;
    pass.index = index;
    pass.spp = spp;
    pass.next_event = next_event;
    pass.record = record;
    pass.blocks_per_unit = 1024;
    return pass;
}

/// Tree that has learned the scene in passes of 4 to 64 spp.
SdTree train(const TraceScene& scene, const Job& job, const Box3& bounds) {
    SdTree tree = initial_tree(bounds, 1.0f);
    std::vector<PixelEstimate> pixels;
    RecordLog log;
    TraceStats stats;
    for (std::uint32_t pass = 0; pass < 5; ++pass) {
        const SdTreeSampler guide(tree);
        CellAccumulator sums(pass, guide);
        test::render_unit(scene, job, make_pass(pass, 4u << pass, false, true), guide, {pass, 0, 0, kSize, kSize, 0},
                          pixels, log, stats);
        sums.commit(log.records, log.counts, log.caps);
        RefineReport report;
        tree = refine(tree, sums.take(), {.spatial_threshold = 1000.0 * (1 << pass)}, report);
    }
    return tree;
}

/// Traces a scene of diffuse surfaces, or one with metals, glass and plastic.
void trace_in(benchmark::State& state, Scene box, bool guided, bool next_event, bool record) {
    test::set_film(box, kSize, kSize);
    const Box3 bounds = box.bounds();
    Job job;
    job.integrator.max_depth = 10;
    job.integrator.rr_depth = 10;
    const TraceScene scene(box, job);
    const SdTreeSampler guide(guided ? train(scene, job, bounds) : initial_tree(bounds, 1.0f));
    if (!guided && !record) job.guiding.type = GuidingType::none;
    std::vector<PixelEstimate> pixels;
    RecordLog log;
    TraceStats stats;
    for (auto _ : state)
        test::render_unit(scene, job, make_pass(9, 16, next_event, record), guide, {9, 0, 0, kSize, kSize, 0}, pixels,
                          log, stats);
    const auto paths = static_cast<double>(stats.paths);
    const auto seconds_each = benchmark::Counter::kIsRate | benchmark::Counter::kInvert;
    state.counters["time/path"] = benchmark::Counter(paths, seconds_each);
    state.counters["time/vertex"] = benchmark::Counter(static_cast<double>(stats.vertices), seconds_each);
    state.counters["rays/path"] = static_cast<double>(stats.rays + stats.shadow_rays) / paths;
    state.counters["vertices/path"] = static_cast<double>(stats.vertices) / paths;
    state.counters["regions"] = guide.region_count();
    state.counters["records/path"] = static_cast<double>(log.records.size()) / (kSize * kSize * 16);
}

void trace(benchmark::State& state, bool guided, bool next_event, bool record) {
    trace_in(state, test::cornell_box(1.0f, Vec3(0.0f)), guided, next_event, record);
}

void trace_glossy(benchmark::State& state, bool guided, bool next_event, bool record) {
    trace_in(state, test::glossy_room(), guided, next_event, record);
}

BENCHMARK_CAPTURE(trace, path, false, false, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace, path_next_event, false, true, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace, first_pass, false, false, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace, first_pass_next_event, false, true, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace, guided, true, false, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace, guided_next_event, true, true, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace, guided_recording, true, false, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace, guided_recording_next_event, true, true, true)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace_glossy, path_next_event, false, true, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace_glossy, guided_next_event, true, true, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(trace_glossy, guided_recording_next_event, true, true, true)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace treefarm
