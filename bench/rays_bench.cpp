// SPDX-License-Identifier: Apache-2.0
// Bare Embree loop over the rays that paths of the same scene send: the yardstick of trace_bench.
#include <benchmark/benchmark.h>

#include "common/math/frame.h"
#include "common/math/warp.h"
#include "tests/support/test_scenes.h"
#include "worker/geometry/embree_api.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {
namespace {

struct Segment {
    Vec3 origin, direction;
    float length;
};

/// Rays of cosine-scattered paths (as in the unguided walk, depth 10), or their vertices' shadow rays.
std::vector<Segment> collect(const TraceScene& scene, bool shadow) {
    std::vector<Segment> segments;
    for (std::uint32_t pixel = 0; pixel < 64 * 64; ++pixel)
        for (std::uint32_t sample = 0; sample < 4; ++sample) {
            const PathKey path{0, pixel, sample};
            Ray ray = scene.camera().generate(int(pixel % 64), int(pixel / 64), draw(path, 0, Stream::camera));
            for (std::uint32_t depth = 1; depth <= 10; ++depth) {
                if (!shadow) segments.push_back({ray.origin, ray.direction, ray.length});
                Hit hit;
                if (!scene.geometry().intersect(ray, hit) || dot(hit.ng, ray.direction) > 0.0f) break;
                if (shadow) {
                    const DirectSample light = scene.emitters().sample_direct(hit.p, draw(path, depth, Stream::light));
                    const Vec3 start = offset_origin(hit, light.wi);
                    if (dot(hit.ng, light.wi) > 0.0f && !is_black(light.radiance))
                        segments.push_back({start, offset_origin(light.on_light, -light.wi) - start, 1.0f});
                }
                const Draw r = draw(path, depth, Stream::scatter);
                const Vec3 d = Frame(hit.ng).to_world(square_to_cosine_hemisphere({to_unit(r[2]), to_unit(r[3])}));
                ray = {offset_origin(hit, d), d};
            }
        }
    return segments;
}

RTCRay to_embree(const Segment& s) {
    return {s.origin.x, s.origin.y, s.origin.z, 0.0f, s.direction.x, s.direction.y, s.direction.z, 0.0f,
            s.length,   ~0u,        0,          0};
}

TraceScene make_scene(bool robust = false) {
    Job job;
    job.farm.robust = robust;
    return TraceScene(test::cornell_box(1.0f, Vec3(0.0f)), job);
}

void count_rays(benchmark::State& state, std::size_t rays) {
    state.counters["time/ray"] = benchmark::Counter(
        static_cast<double>(rays), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["rays/path"] = static_cast<double>(rays) / (64 * 64 * 4);
}

void closest_hit(benchmark::State& state) {
    const TraceScene scene = make_scene();
    const std::vector<Segment> segments = collect(scene, false);
    EmbreeRays rays;
    for (auto _ : state)
        for (const Segment& s : segments) {
            RTCRayHit query;
            query.ray = to_embree(s);
            query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
            rays.intersect(scene.geometry().handle(), query);
            benchmark::DoNotOptimize(query.ray.tfar);
        }
    count_rays(state, segments.size());
}

void closest_hit_with_surface(benchmark::State& state) {
    const TraceScene scene = make_scene();
    const std::vector<Segment> segments = collect(scene, false);
    for (auto _ : state)
        for (const Segment& s : segments) {
            Hit hit;
            benchmark::DoNotOptimize(scene.geometry().intersect({s.origin, s.direction, s.length}, hit));
            benchmark::DoNotOptimize(hit.p);
        }
    count_rays(state, segments.size());
}

/// Closest hits of the same segments with farm.robust, to measure its cost.
void closest_hit_watertight(benchmark::State& state) {
    const TraceScene scene = make_scene(true);
    const std::vector<Segment> segments = collect(scene, false);
    for (auto _ : state)
        for (const Segment& s : segments) {
            Hit hit;
            const Ray ray{s.origin, s.direction, s.length};
            if (scene.geometry().intersect(ray, hit)) scene.geometry().keep_inside(hit, ray);
            benchmark::DoNotOptimize(hit.p);
        }
    count_rays(state, segments.size());
}

void any_hit(benchmark::State& state) {
    const TraceScene scene = make_scene();
    const std::vector<Segment> segments = collect(scene, true);
    EmbreeRays rays;
    for (auto _ : state)
        for (const Segment& s : segments) {
            RTCRay query = to_embree(s);
            rays.occluded(scene.geometry().handle(), query);
            benchmark::DoNotOptimize(query.tfar);
        }
    count_rays(state, segments.size());
}

/// Tracing, scattering and random numbers in a minimal loop, nothing stored: the bound for any path tracer on Embree.
void bare_paths(benchmark::State& state) {
    const TraceScene scene = make_scene();
    std::size_t rays = 0;
    for (auto _ : state)
        for (std::uint32_t pixel = 0; pixel < 64 * 64; ++pixel)
            for (std::uint32_t sample = 0; sample < 4; ++sample) {
                const PathKey path{0, pixel, sample};
                Ray ray = scene.camera().generate(int(pixel % 64), int(pixel / 64), draw(path, 0, Stream::camera));
                for (std::uint32_t depth = 1; depth <= 10; ++depth) {
                    Hit hit;
                    ++rays;
                    if (!scene.geometry().intersect(ray, hit) || dot(hit.ng, ray.direction) > 0.0f) break;
                    const Draw r = draw(path, depth, Stream::scatter);
                    const Vec3 d = Frame(hit.ng).to_world(square_to_cosine_hemisphere({to_unit(r[2]), to_unit(r[3])}));
                    ray = {offset_origin(hit, d), d};
                }
                benchmark::DoNotOptimize(ray);
            }
    state.counters["time/ray"] =
        benchmark::Counter(static_cast<double>(rays), benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
    state.counters["time/path"] =
        benchmark::Counter(64.0 * 64 * 4, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

BENCHMARK(closest_hit)->Unit(benchmark::kMillisecond);
BENCHMARK(closest_hit_with_surface)->Unit(benchmark::kMillisecond);
BENCHMARK(closest_hit_watertight)->Unit(benchmark::kMillisecond);
BENCHMARK(any_hit)->Unit(benchmark::kMillisecond);
BENCHMARK(bare_paths)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace treefarm
