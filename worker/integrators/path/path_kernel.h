// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <numeric>

#include "worker/integrators/path/path_walk.h"
#include "worker/integrators/subpath/radiance.h"

namespace treefarm {

/// Tracer of the camera paths of a group: schedules them, and sums their samples. One kernel per thread.
///
/// Other branches of paths that were split at glass, and split paths, wait until the camera paths of the whole group
/// are done: they are few, and walk together. The paths split off by these follow in the next round.
template <GuideWalk G, class Surface, bool kGuided, bool kRecord, class Observer = NoObserver>
class PathKernel {
    using Walk = PathWalk<G, Surface, kGuided, kRecord, Observer>;

    static constexpr std::uint32_t kBatch = Walk::kBatch;

  public:
    static constexpr std::uint32_t kGroup = 8 * kBatch;

    /// Records are appended to `log`.
    PathKernel(const TraceScene& scene, const typename G::Sampler& guide, const PathSettings& settings,
               UnitStats& stats, LogOf<G>* log = nullptr)
        : stats_(stats),
          log_(log),
          walk_(scene, guide, settings, stats, log ? std::span(log->next_event) : std::span<NextEventSums>()) {
        assert(log || !kRecord);
        std::iota(slots_.begin(), slots_.end(), std::uint8_t{0});
    }

    void clear() { count_ = 0; }
    std::uint32_t count() const { return count_; }
    bool full() const { return count_ == kGroup; }

    /// Adds a camera path; the kernel must not be full. `inverse_level`: one over the light about the pixel; 0:
    /// unknown.
    void add(const PathKey& key, const Ray& ray, float inverse_level = 0.0f) {
        assert(!full());
        inverse_levels_[count_] = inverse_level;
        keys_[count_] = key;
        rays_[count_++] = ray;
    }

    /// Traces the added paths.
    void trace() {
        if (walk_.settings().max_depth == 0) {
            std::fill_n(radiance_.begin(), count_, Rgb(0.0f));
            return;
        }
        walk_camera_paths();
        if constexpr (Surface::kTransmits)
            if (walk_.glass_splits().size() != 0) walk_other_branches();
        if constexpr (kGuided)
            if (!walk_.split_paths().empty()) walk_split_paths();
    }

    /// Radiance along the camera ray of path number `path`, in the order of add().
    const Rgb& radiance(std::uint32_t path) const { return radiance_[path]; }
    /// Luminance that path `path` would have without splitting; for guided paths that record.
    float unsplit(std::uint32_t path) const { return unsplit_[path]; }
    /// Exponent of the power of two in which unsplit() is counted, from the records of the region at the camera ray's
    /// hit.
    int first_exponent(std::uint32_t path) const { return first_exponents_[path]; }
    /// Estimate of unguided cost and variance from path `path`, if the pass asks for it; for guided paths that record.
    const UnguidedTotal& unguided(std::uint32_t path) const { return unguided_[path]; }
    /// One over the light about the pixel, as given to add().
    float inverse_level(std::uint32_t path) const { return inverse_levels_[path]; }
    Observer& observer() { return walk_.observer(); }
    PhaseClock& clock() { return walk_.clock(); }

  private:
    using Path = typename Walk::Path;

    static constexpr std::uint32_t kOtherBranchVertices = 1u << 28;

    /// Whether a path that ends makes its slot free for the next. For guided paths this was slower: their next batch
    /// waits for the last path (bench/log/speed.md, "what made paths faster").
    static constexpr bool kRefills = !kGuided;

    /// Number of paths that walk together; whole batches are slower for guided paths without next event.
    std::uint32_t batch() const {
        if constexpr (Observer::kOneByOne) return 1;
        return kGuided && !walk_.settings().next_event ? kBatch / 2 : kBatch;
    }

    /// State with which splitting continues on the other branch of a camera path.
    struct SplittingState {
        SplitBudget split_budget;
        int first_exponent;
    };
    static constexpr bool kInherits = kGuided && Surface::kTransmits;
    static constexpr bool kCompares = kGuided && kRecord;

    /// Walks `count` paths, up to a batch at a time: begin(number, slot) sets one up, and end(number, path) receives
    /// its result.
    template <class Begin, class End>
    void walk(std::uint32_t count, Begin begin, End end) {
        std::array<std::uint32_t, kBatch> numbers;  // by slot
        std::uint32_t begun = 0;
        const auto fill = [&](std::span<const std::uint8_t> slots) {
            const std::uint32_t others = std::min(count - begun, static_cast<std::uint32_t>(slots.size()));
            for (const std::uint8_t slot : slots.first(others)) {
                numbers[slot] = begun;
                begin(begun++, slot);
            }
            return others;
        };
        while (begun < count) {  // NOLINT(bugprone-infinite-loop): fill() counts
            const std::uint32_t first = fill(std::span(slots_).first(batch()));
            walk_.walk(std::span(slots_).first(first), [&](std::span<const std::uint8_t> ended) {
                for (const std::uint8_t slot : ended)
                    end(numbers[slot], walk_[slot]);
                commit(ended);
                return kRefills ? fill(ended) : 0;
            });
        }
    }

    void walk_camera_paths() {
        walk(
            count_,
            [&](std::uint32_t number, std::uint8_t slot) {
                Path& path = walk_[slot];
                path.begin(keys_[number], rays_[number]);
                path.origin = static_cast<std::uint16_t>(number);
                path.inverse_level = inverse_levels_[number];
                if constexpr (kRecord) walk_.recorder(slot).begin_path();
                walk_.observer().camera(path.ray);
            },
            [&](std::uint32_t number, const Path& path) {
                radiance_[number] = path.radiance;
                if constexpr (kCompares) {
                    unsplit_[number] = path.unsplit.of(luminance(path.radiance));
                    first_exponents_[number] = path.first_exponent;
                    unguided_[number] = {path.unguided.moment(), path.unguided.cost()};
                }
                if constexpr (kInherits) splitting_states_[number] = {path.split_budget, path.first_exponent};
            });
    }

    /// Walks the other branches of paths that were split at their first surface.
    [[gnu::noinline]] void walk_other_branches() {
        const GlassSplits& glass_splits = walk_.glass_splits();
        walk(
            glass_splits.size(),
            [&](std::uint32_t number, std::uint8_t slot) {
                const GlassSplits::OtherBranch& branch = glass_splits[number];
                Path& path = walk_[slot];
                path.begin(keys_[branch.origin], branch.ray);
                path.origin = branch.origin;
                path.inverse_level = inverse_levels_[branch.origin];
                if constexpr (kInherits) {
                    path.split_budget = splitting_states_[branch.origin].split_budget;
                    path.first_exponent = splitting_states_[branch.origin].first_exponent;
                }
                path.radiance = radiance_[branch.origin];
                path.resume(branch.ray, branch.weight, branch.spread, kOtherBranchVertices + 1);
                if constexpr (kRecord) walk_.recorder(slot).begin_other_branch(branch.weight);
                walk_.observer().other_branch(branch.ray, branch.weight);
            },
            [&](std::uint32_t, const Path& path) {
                Rgb& radiance = radiance_[path.origin];
                if constexpr (kCompares) {
                    // Both branches belong to one sample, whose square includes twice their product.
                    float& first = unsplit_[path.origin];
                    const float second = path.unsplit.of(luminance(path.radiance)) - luminance(radiance);
                    const float level = path.inverse_level;
                    unguided_[path.origin].add(path.unguided, 2.0f * (first * level) * (second * level));
                    first += second;
                }
                radiance = path.radiance;
            });
        walk_.glass_splits().clear();
    }

    [[gnu::noinline]] void walk_split_paths() {
        numbers_.fill(0);
        while (!walk_.split_paths().empty()) {
            const std::span<const SplitPath> split_paths = walk_.split_paths().next(numbers_);
            split_radiance_.resize(split_paths.size());
            if constexpr (kCompares) split_unguided_.resize(split_paths.size());
            walk(
                static_cast<std::uint32_t>(split_paths.size()),
                [&](std::uint32_t number, std::uint8_t slot) {
                    walk_[slot].begin(keys_[split_paths[number].origin], split_paths[number]);
                    walk_[slot].inverse_level = inverse_levels_[split_paths[number].origin];
                    if constexpr (kRecord) walk_.recorder(slot).begin_path();
                    walk_.observer().split_path(split_paths[number]);
                },
                [&](std::uint32_t number, const Path& path) {
                    split_radiance_[number] = path.radiance;
                    if constexpr (kCompares) split_unguided_[number] = {path.unguided.moment(), path.unguided.cost()};
                    stats_.split_path_rays += static_cast<std::uint32_t>(path.depth - split_paths[number].depth);
                });
            // Added in their own order: the order in which they ended depends on the other paths.
            for (std::size_t i = 0; i < split_paths.size(); ++i)
                radiance_[split_paths[i].origin] += split_radiance_[i];
            if constexpr (kCompares)
                for (std::size_t i = 0; i < split_paths.size(); ++i)
                    unguided_[split_paths[i].origin].add(split_unguided_[i]);
        }
    }

    /// Hands over the records of the paths in these slots. Invalid radiance is dropped and teaches nothing.
    void commit([[maybe_unused]] std::span<const std::uint8_t> slots) {
        if constexpr (kRecord) {
            walk_.clock().start();
            for (const std::uint8_t slot : slots) {
                const auto& path = walk_[slot];
                if (!is_radiance(path.radiance)) continue;
                stats_.records += walk_.recorder(slot).commit(*log_);
                if constexpr (requires { G::teach_path(*log_, path.key, path.radiance); })
                    G::teach_path(*log_, path.key, path.radiance);
            }
            walk_.clock().lap(TracePhase::record);
        }
    }

    UnitStats& stats_;
    LogOf<G>* log_;
    Walk walk_;
    std::uint32_t count_ = 0;
    std::array<std::uint8_t, kBatch> slots_;
    std::array<PathKey, kGroup> keys_;
    std::array<Ray, kGroup> rays_;
    std::array<float, kGroup> inverse_levels_;
    std::array<Rgb, kGroup> radiance_;
    std::array<SplittingState, kInherits ? kGroup : 0> splitting_states_;
    std::array<float, kCompares ? kGroup : 0> unsplit_;
    std::array<int, kCompares ? kGroup : 0> first_exponents_;
    std::array<UnguidedTotal, kCompares ? kGroup : 0> unguided_;
    std::array<std::uint8_t, kGroup> numbers_;  ///< number of split paths so far, per camera path
    std::vector<Rgb> split_radiance_;           ///< radiance of each split path
    std::vector<UnguidedTotal> split_unguided_;
};

}  // namespace treefarm
