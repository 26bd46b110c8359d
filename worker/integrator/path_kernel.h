#pragma once

#include <numeric>

#include "worker/integrator/path_walk.h"
#include "worker/integrator/radiance.h"

namespace treefarm {

/// The camera paths of a group, traced: which paths walk, batch after batch, and what their samples come to. One kernel
/// per thread.
///
/// The copies that paths leave where they are split are few, so they wait until the camera paths of the whole group
/// are done, and walk together; then their own copies do.
template <class Surface, bool kGuided, bool kRecord, class Observer = NoObserver>
class PathKernel {
    using Walk = PathWalk<Surface, kGuided, kRecord, Observer>;

    static constexpr std::uint32_t kBatch = Walk::kBatch;

  public:
    static constexpr std::uint32_t kGroup = 4 * kBatch;

    /// `log` is where records go.
    PathKernel(const TraceScene& scene, const Guide& guide, const PathSettings& settings, TraceStats& stats,
               RecordLog* log = nullptr)
        : stats_(stats), log_(log), walk_(scene, guide, settings, stats) {
        assert(log || !kRecord);
        std::iota(places_.begin(), places_.end(), std::uint8_t{0});
    }

    void clear() { count_ = 0; }
    std::uint32_t count() const { return count_; }
    bool full() const { return count_ == kGroup; }

    /// Adds a camera path. Not when full.
    void add(const PathKey& key, const Ray& ray) {
        assert(!full());
        if (waiting_ == batch()) walk_waiting();
        auto& path = walk_[waiting_];
        path.begin(key, ray);
        path.origin = static_cast<std::uint16_t>(count_);
        path.probe = kGuided && walk_.settings().probe.holds(key.pixel);
        stats_.probe_paths += path.probe;
        if constexpr (kRecord) walk_.recorder(waiting_).begin_path();
        walk_.observer().camera(ray);
        keys_[count_++] = key;
        ++waiting_;
    }

    /// Traces what was added.
    void trace() {
        walk_waiting();
        if constexpr (kGuided)
            if (!walk_.copies().empty()) follow_copies();
    }

    /// Radiance along the camera ray of the path added as number `path`.
    const Rgb& radiance(std::uint32_t path) const { return radiance_[path]; }
    Observer& observer() { return walk_.observer(); }
    PhaseClock& clock() { return walk_.clock(); }

  private:
    static constexpr std::uint32_t kBranchVertices = 1u << 28;

    /// How many camera paths walk together: with next event they were faster by whole batches, guided ones without it
    /// slower (docs/architecture.md, "How paths walk").
    std::uint32_t batch() const { return kGuided && !walk_.settings().next_event ? kBatch / 2 : kBatch; }

    std::span<const std::uint8_t> places(std::size_t count) const { return {places_.data(), count}; }

    void walk_waiting() {
        const std::uint32_t first = count_ - waiting_;
        if (walk_.settings().max_depth != 0) {
            walk_.walk(places(waiting_));
            if constexpr (Surface::kTransmits) follow_branches();
        }
        for (std::uint32_t i = 0; i < waiting_; ++i)
            radiance_[first + i] = walk_[i].radiance;
        commit(waiting_);
        waiting_ = 0;
    }

    /// The other ways of paths that were split at their first surface.
    [[gnu::noinline]] void follow_branches() {
        Branches& branches = walk_.branches();
        std::array<std::uint8_t, kBatch> of;
        for (std::uint32_t i = 0; i < branches.size(); ++i) {
            const Branches::Branch& branch = branches[i];
            of[i] = branch.path;
            walk_[branch.path].resume(branch.ray, branch.weight, branch.spread, kBranchVertices + 1);
            if constexpr (kRecord) walk_.recorder(branch.path).begin_branch(branch.weight);
            walk_.observer().branch(branch.ray, branch.weight);
        }
        const std::uint32_t count = branches.size();
        branches.clear();
        walk_.walk({of.data(), count});
    }

    /// As many at a time as a batch holds.
    [[gnu::noinline]] void follow_copies() {
        numbers_.fill(0);
        while (!walk_.copies().empty()) {
            std::span<const PathCopy> left = walk_.copies().next(numbers_);
            while (!left.empty()) {
                const auto copies = left.first(std::min<std::size_t>(left.size(), kBatch));
                left = left.subspan(copies.size());
                for (std::uint32_t i = 0; i < copies.size(); ++i) {
                    walk_[i].begin(keys_[copies[i].origin], copies[i]);
                    if constexpr (kRecord) walk_.recorder(i).begin_path();
                    walk_.observer().copy(copies[i]);
                }
                walk_.walk(places(copies.size()));
                for (std::uint32_t i = 0; i < copies.size(); ++i)
                    radiance_[copies[i].origin] += walk_[i].radiance;
                commit(static_cast<std::uint32_t>(copies.size()));
            }
        }
    }

    /// Hands over what the paths in the first places learned. What carried no radiance but nonsense teaches nothing.
    void commit([[maybe_unused]] std::uint32_t count) {
        if constexpr (kRecord) {
            walk_.clock().start();
            for (std::uint32_t i = 0; i < count; ++i)
                if (!walk_[i].probe && is_radiance(walk_[i].radiance))
                    stats_.records += walk_.recorder(i).commit(*log_);
            walk_.clock().lap(TracePhase::record);
        }
    }

    TraceStats& stats_;
    RecordLog* log_;
    Walk walk_;
    std::uint32_t count_ = 0, waiting_ = 0;  ///< paths added; those of them that have not walked
    std::array<std::uint8_t, kBatch> places_;
    std::array<PathKey, kGroup> keys_;
    std::array<Rgb, kGroup> radiance_;
    std::array<std::uint8_t, kGroup> numbers_;  ///< of copies so far
};

}  // namespace treefarm
