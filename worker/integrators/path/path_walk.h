// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

#include "worker/integrators/path/direction_choice.h"
#include "worker/integrators/path/emission.h"
#include "worker/integrators/path/emitter_choice.h"
#include "worker/integrators/path/ended_paths.h"
#include "worker/integrators/path/glass_splits.h"
#include "worker/integrators/path/guide_walk.h"
#include "worker/integrators/path/light_chances.h"
#include "worker/integrators/path/path_observer.h"
#include "worker/integrators/path/path_roulette.h"
#include "worker/integrators/path/phase_clock.h"
#include "worker/integrators/path/seen_light.h"
#include "worker/integrators/path/vertex_records.h"
#include "worker/integrators/unit_stats.h"
#include "worker/scene/surface.h"

namespace treefarm {

/// Path tracing with optional next event, guiding and recording (Mueller et al. 2017; tests in the order of their
/// program). Depth counts path edges: a surface seen by the camera has depth 1. `G`: guide_walk.h.
///
/// Up to kBatch paths walk in step: latencies of one (memory, square roots) are hidden by the others, and the shadow
/// rays of a step are traced together. A path's result does not depend on the other paths of its batch.
template <GuideWalk G, class Surface, bool kGuided, bool kRecord, class Observer = NoObserver>
class PathWalk {
  public:
    static constexpr std::uint32_t kBatch = kDrawBatch;
    using Path = PathState<G, Surface>;
    using Recorder = PathRecorder<G>;

    PathWalk(const TraceScene& scene, const typename G::Sampler& guide, const PathSettings& settings, UnitStats& stats,
             std::span<NextEventSums> direct_light = {})
        : scene_(scene),
          guide_(guide),
          settings_(settings),
          stats_(stats),
          clock_(settings.profile, stats),
          scratch_(kBatch, Surface::make_scratch(scene)),
          emitters_(scene.emitters(), settings),
          directions_(guide, settings),
          direction_records_(guide, settings),
          counts_(stats, direct_light),
          chances_(guide, settings_, counts_),
          emission_(scene, settings_, observer_, counts_) {
        recorders_.fill(Recorder({settings.target, settings.view_records, settings.bootstrap}));
    }

    PathWalk(const PathWalk&) = delete;
    /// Path slot; filled by the caller before walk().
    Path& operator[](std::uint32_t slot) { return paths_[slot]; }
    Recorder& recorder(std::uint32_t slot) { return recorders_[slot]; }

    /// Traces the paths in these slots, at most kBatch, to their ends. `follow(slots)` is called with slots whose paths
    /// have ended; it refills the first of them and returns how many.
    template <class Follow>
    void walk(std::span<const std::uint8_t> slots, Follow follow) {
        std::copy(slots.begin(), slots.end(), alive_.begin());
        ended_.clear();
        for (auto alive = static_cast<std::uint32_t>(slots.size()); alive != 0;)
            alive = ended_.replace(step(alive), alive_, follow);
    }

    /// Branches at glass and split paths that the traced paths left; the caller of walk() traces and removes them.
    GlassSplits& glass_splits() { return glass_; }
    SplitPaths& split_paths() { return split_paths_; }
    const PathSettings& settings() const { return settings_; }
    Observer& observer() { return observer_; }
    PhaseClock& clock() { return clock_; }

  private:
    /// kConverts: directions are converted to codes; kLocal: guidance depends on more than the region.
    static constexpr bool kConverts = kGuided || kRecord, kLocal = kConverts && G::kLocal;

    /// Traces one more edge of the first `alive` of alive_; returns how many paths continue.
    std::uint32_t step(std::uint32_t alive) {
        clock_.start();
        std::array<EmbreeScene::Query, kBatch> queries;
        std::uint32_t count = 0;
        for (std::uint32_t lane = 0; lane < alive; ++lane) {
            Path& path = paths_[alive_[lane]];
            path.lane = static_cast<std::uint8_t>(lane);
            ++path.vertex;
            ++path.depth;
            if (kGuided && path.was_split_off) continue;
            ++stats_.rays;
            if constexpr (kGuided)
                if (settings_.estimates_unguided) path.unguided.add_cost(1.0f);
            observer_.ray(path.ray);
            queries[count++] = {&path.ray, &path.embree_hit, &path.found};
        }
        scene_.geometry().intersect({queries.data(), count});
        clock_.lap(TracePhase::intersect);
        if constexpr (Surface::kGeneral)  // other scenes are mostly small
            arrivals(alive, [&](std::uint32_t, Path& path) { scene_.geometry().prefetch_point(path.embree_hit); });
        draw_numbers(alive);
        arrivals(alive, [&](std::uint32_t, Path& path) { scene_.geometry().set_point(path.hit, path.embree_hit); });
        if (settings_.textured)
            arrivals(alive, [&](std::uint32_t, Path& path) { Surface::prefetch(scene_, path.hit); });
        clock_.lap(TracePhase::surface);
        if constexpr (kConverts) find_regions(alive);
        pending_.clear();
        alive = keep(alive, [&](std::uint8_t path) {
            if constexpr (kGuided) directions_.prefetch_more(paths_[path]);
            return visit(path);
        });
        if (emitters_.together()) [[unlikely]]
            sample_emitters_together(alive);
        clock_.lap(TracePhase::surface);
        if (!pending_.empty()) look_at_lights();
        clock_.lap(TracePhase::shadow);
        alive = go_on(alive);
        clock_.lap(TracePhase::direction);
        if constexpr (kRecord) {
            direction_records_.template add<Surface>(paths_, {alive_.data(), alive}, recorders_);
            clock_.lap(TracePhase::record);
        }
        return alive;
    }

    /// Chooses the next directions; returns how many paths continue.
    std::uint32_t go_on(std::uint32_t alive) {
        const auto draws = [&](std::uint8_t path) { return directions_.draw(paths_[path]) || end("no direction"); };
        const auto leaves = [&](std::uint8_t path) {
            directions_.complete(paths_[path]);
            return leave(path);
        };
        directions_.start(paths_, {alive_.data(), alive});
        if constexpr (!kConverts) return keep(alive, [&](std::uint8_t path) { return draws(path) && leaves(path); });
        alive = keep(alive, draws);
        directions_.convert();
        if constexpr (kGuided) directions_.choose(paths_, {alive_.data(), alive});
        return keep(alive, leaves);
    }

    /// Keeps those of the first `alive` paths of alive_ for which `goes_on` holds; returns their number.
    template <class GoesOn>
    std::uint32_t keep(std::uint32_t alive, GoesOn goes_on) {
        std::uint32_t left = 0;
        for (std::uint32_t i = 0; i < alive; ++i) {
            const std::uint8_t path = alive_[i];
            if (goes_on(path))
                alive_[left++] = path;
            else
                ended_.add(path);
        }
        return left;
    }

    /// Calls visit(lane, path) for each of the first `alive` paths of alive_ that has hit a surface.
    template <class Visit>
    void arrivals(std::uint32_t alive, Visit visit) {
        for (std::uint32_t lane = 0; lane < alive; ++lane)
            if (Path& path = paths_[alive_[lane]]; path.found) visit(lane, path);
    }

    void find_regions(std::uint32_t alive) {
        VectorBatch points;
        std::array<std::uint32_t, kBatch> regions;
        std::uint32_t count = 0;
        arrivals(alive, [&](std::uint32_t, Path& path) { points.set(count++, path.hit.p); });
        guide_.regions(points, count, regions);
        count = 0;
        arrivals(alive, [&](std::uint32_t lane, Path& path) {
            const std::uint32_t region = path.guidance.region = regions[count++];
            if (kGuided && path.depth == 1) path.first_exponent = guide_.quantum_exponent(region);
            if constexpr (kGuided) directions_.prefetch(region, lane);
        });
        clock_.lap(TracePhase::direction);
    }

    /// Draws the random numbers of a step, for all paths together.
    void draw_numbers(std::uint32_t alive) {
        KeyBatch keys;
        int depth = 0;
        for (std::uint32_t i = 0; i < alive; ++i) {
            const Path& path = paths_[alive_[i]];
            keys.pixel[i] = path.key.pixel;
            keys.sample[i] = path.key.sample;
            keys.vertex[i] = path.vertex;
            depth = std::max(depth, path.depth);
        }
        const std::uint64_t seed = paths_[alive_[0]].key.seed;
        directions_.draw_numbers(seed, keys, paths_, {alive_.data(), alive});
        emitters_.draw_numbers(seed, keys, alive);
        if (settings_.thin_next_event || (depth > 1 && settings_.roulette.plays(depth - 1)))
            draw_batch(seed, keys, alive, ~0u, Stream::roulette, roulette_draws_);  // of the previous vertex
        if constexpr (kRecord) direction_records_.draw_numbers(seed, keys, alive);
    }

    /// Handles the arrival of a path's ray: emission, roulette and splitting. False if the path ends.
    bool arrive(Path& path, Recorder* recorder) {
        if (!path.found) {
            if (scene_.emitters().shines_from_infinity()) [[unlikely]]
                emission_.from_infinity(path, recorder);
            return end("left the scene");
        }
        if (scene_.emitters().emits(path.hit.shape)) [[unlikely]]
            emission_.from_emitter(path, recorder);
        if (path.depth == settings_.max_depth) return end("depth limit");
        if (path.depth == 1) return true;
        if (settings_.roulette.plays(path.depth - 1)) {
            const float chance = survival<kGuided>(path, guide_, settings_);
            const bool survives = to_unit(roulette_draws_.word[0][path.lane]) < chance;
            observer_.roulette(chance, survives);
            if (!survives) return end("roulette");
            if constexpr (kGuided)
                if (settings_.estimates_unguided) path.unguided.step(chance, unguided_survival(path, settings_));
            path.throughput *= 1.0f / chance;
            if constexpr (kRecord) recorder->survive(chance);
        }
        if constexpr (kGuided)
            if (const std::uint32_t paths = splitting(path, guide_, settings_); paths > 1) [[unlikely]]
                observer_.split(path.split(paths, split_paths_), path.throughput);
        return true;
    }

    /// Visits the surface that a path's ray has hit. False if the path ends.
    bool visit(std::uint8_t index) {
        Path& path = paths_[index];
        const Hit& hit = path.hit;
        const Ray& ray = path.ray;
        observer_.arrive(path.depth, path.found ? &hit : nullptr);
        if (kGuided && path.was_split_off) [[unlikely]]
            path.was_split_off = false;
        else if (!arrive(path, kRecord ? &recorders_[index] : nullptr))
            return false;
        else
            scene_.geometry().keep_inside(path.hit, ray);
        const Surface& surface = path.surface.emplace(scene_, hit, -ray.direction, scratch_[index]);
        if (surface.black()) return end("black surface");
        if (settings_.strict_normals && -dot(surface.ng(), ray.direction) * surface.wo().z < 0.0f)
            return end("normals disagree");
        ++stats_.vertices;
        path.guidance.bsdf_fraction = kGuided && surface.smooth() ? guide_.bsdf_fraction(path.guidance.region) : 1.0f;
        if constexpr (kLocal)
            G::template localise<kGuided>(guide_, surface, hit.p, -ray.direction, path.outgoing, path.guidance);
        if constexpr (kGuided && kLocal) directions_.prefetch_local(path);
        if constexpr (kRecord)
            if (surface.smooth() && !guide_.contains(hit.p)) recorders_[index].add_outside();
        if (emitters_.any() && surface.smooth()) {
            chances_.decide(path, roulette_draws_);
            if (!emitters_.together() && chances_.needs_emitter(path)) next_event(index);
        }
        return true;
    }

    /// Continues a path in the drawn direction. False if it carries nothing.
    bool leave(std::uint8_t index) {
        Path& path = paths_[index];
        const Surface& surface = *path.surface;
        const auto& s = path.scatter;
        if constexpr (Surface::kTransmits)
            if (s.delta && path.depth == 1 && settings_.split_glass) glass_.split(path, settings_.strict_normals);
        if (!(s.pdf > 0.0f) || is_black(s.f_cos)) return end("no direction");
        if (settings_.strict_normals && dot(surface.ng(), s.world) * s.local.z <= 0.0f) return end("normals disagree");
        path.weight = s.f_cos * (1.0f / s.effective_pdf);
        path.throughput *= path.weight;
        observer_.scatter(surface, s, path.throughput);
        path.scatter_pdf = s.pdf;
        if constexpr (kGuided)
            if (settings_.estimates_unguided) path.follow_unguided();
        path.scatter_from = receiver(path);
        path.scatter_light_samples = path.light_samples;
        if constexpr (kConverts) path.scatter_region = path.guidance.region;
        if (surface.smooth() && chances_.needs_emitter(path))
            emitters_.keep(path.lane, path.scatter_from, path.scatter_widths);
        // One test for both rare cases: the same bits mean that a lobe may be delta, or refract.
        const bool rare = Surface::kGeneral && surface.delta_or_transmitting();
        if constexpr (Surface::kTransmits)
            if (rare && s.local.z < 0.0f) path.spread *= surface.eta2();
        assert(path.spread == 1.0f || scene_.effects().transmission);
        if (rare && s.delta) path.scatter_pdf = std::numeric_limits<float>::infinity();
        path.ray = {offset_origin(path.hit, s.world), s.world};
        return true;
    }

    bool end(const char* why) {
        observer_.end(why);
        return false;
    }

    /// Samples emitters in batches; out of line, since most scenes only pay one test for it.
    [[gnu::noinline]] void sample_emitters_together(std::uint32_t alive) {
        std::array<std::uint8_t, kBatch> smooth;
        std::uint32_t count = 0;
        emitters_.clear();
        for (std::uint32_t i = 0; i < alive; ++i) {
            const Path& path = paths_[alive_[i]];
            if (!path.surface->smooth() || !chances_.needs_emitter(path)) continue;
            smooth[count++] = alive_[i];
            emitters_.choose(path, receiver(path));
        }
        emitters_.draw();
        for (std::uint32_t i = 0; i < count; ++i)
            if constexpr (Surface::kGeneral)
                next_event(smooth[i]);
            else
                sample_emitter(smooth[i]);
    }

    /// Point of a path's vertex, as next event chooses an emitter for it.
    LightReceiver receiver(const Path& path) const {
        const Vec3 front = path.surface->front();
        return {path.hit.p, kConverts ? guide_.light_probabilities(path.guidance.region) : nullptr,
                path.surface->transmits() ? nullptr : &front};
    }

    void next_event(std::uint8_t index) { sample_emitter(index); }
    /// Samples an emitter; its visibility is tested for all paths of a step together. Inlined if surfaces are simple.
    [[gnu::always_inline]] void sample_emitter(std::uint8_t index) {
        const Path& path = paths_[index];
        const Surface& surface = *path.surface;
        const LightReceiver at = receiver(path);
        const DirectSample light = emitters_.sample(at, path);
        if (!chances_.accepts(path, light.delta) || !(light.pdf > 0.0f) || light.black()) return;
        BsdfValue bsdf;
        if (surface.evaluate_late()) {
            if (at.one_sided && !(dot(at.front, light.wi) > 0.0f)) return;
        } else {
            bsdf = bsdf_towards(surface, light.wi);
            if (is_black(bsdf.f_cos)) return;
        }
        if (settings_.strict_normals && dot(surface.ng(), light.wi) * dot(surface.frame().n, light.wi) <= 0.0f) return;
        ++stats_.shadow_rays;
        chances_.traced(paths_[index], light.delta);
        const std::uint32_t vertex = kRecord ? recorders_[index].vertex_count() : 0;
        pending_.add(path.hit, light,
                     {index, vertex, light.delta ? 1.0f : path.light_samples,
                      !settings_.delta_alone && at.probabilities, path.guidance, path.throughput},
                     bsdf);
    }

    /// Traces the step's shadow rays, and adds the visible samples, weighted against scattering.
    void look_at_lights() {
        const std::span<const bool> shadowed = pending_.trace(scene_.geometry(), observer_);
        std::array<std::uint8_t, kBatch> seen;
        std::uint32_t count = 0;
        light_directions_.clear();
        for (std::uint32_t i = 0; i < pending_.size(); ++i) {
            if (shadowed[i] || !reflects(*paths_[pending_[i].from.path].surface, pending_[i])) continue;
            seen[count++] = static_cast<std::uint8_t>(i);
            if constexpr (kConverts) light_directions_.add(pending_[i].wi, pending_[i].from.guidance);
        }
        if constexpr (kConverts) light_directions_.convert();
        if constexpr (kGuided) light_directions_.prefetch(guide_);
        emitters_.shine_from_infinity(pending_, {seen.data(), count},
                                      [&](const PendingLight<G>& light) { return paths_[light.from.path].lane; });
        if constexpr (kGuided) light_directions_.prefetch_more(guide_);
        for (std::uint32_t i = 0; i < count; ++i)
            add_light(pending_[seen[i]], light_directions_[i]);
    }

    void add_light(const PendingLight<G>& light, const typename G::Direction& direction) {
        if (!(light.pdf > 0.0f)) return;  // an environment map's density is known only now
        Path& path = paths_[light.from.path];
        const SeenLight seen = see_light<G, kGuided>(light, direction, guide_, settings_);
        const Rgb carried = light.from.throughput * seen.reflected;
        path.radiance += carried;
        if constexpr (kGuided)
            if (settings_.estimates_unguided)
                path.unguided.add(unguided_light(light, seen, settings_) * path.inverse_level);
        chances_.add(path, light, seen, carried);
        observer_.next_event(*path.surface, light, seen.scatter_pdf, seen.weight, carried);
        if constexpr (kRecord)
            record_light(light, seen.reflected, seen.weight, direction, path, guide_, settings_,
                         recorders_[light.from.path]);
    }

    const TraceScene& scene_;
    const typename G::Sampler& guide_;
    const PathSettings settings_;
    UnitStats& stats_;
    PhaseClock clock_;
    std::vector<typename Surface::Scratch> scratch_;  ///< a path's surface exists for one step
    std::array<Path, kBatch> paths_;
    std::array<std::uint8_t, kBatch> alive_;
    EndedPaths ended_;
    GlassSplits glass_;
    SplitPaths split_paths_;
    DrawBatch roulette_draws_;
    EmitterChoice emitters_;
    DirectionChoice<G, Surface, kGuided, kConverts> directions_;
    typename G::LightBatch light_directions_;
    PendingLights<G> pending_;
    std::array<Recorder, kRecord ? kBatch : 0> recorders_;
    DirectionRecords<G> direction_records_;
    [[no_unique_address]] Observer observer_;
    NextEventCounts<kRecord> counts_;
    LightChances<G, kConverts, kRecord> chances_;
    Emission<G, Surface, kRecord, Observer> emission_;
};

}  // namespace treefarm
