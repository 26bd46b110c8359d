// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/guiding/any_guide.h"
#include "common/plan/resolve/resolve.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// Expected bytes of one kind of data.
struct MemoryItem {
    std::string name;
    std::uint64_t bytes = 0;
    std::string formula;  ///< one line: how the figure is computed
};

struct MemoryPlan {
    std::vector<MemoryItem> worker;  ///< of one worker process, for any number of threads
    std::vector<MemoryItem>
        coordinator;  ///< beside its packed copy of the scene; none of it grows with the number of workers

    std::uint64_t worker_bytes() const;
    std::uint64_t coordinator_bytes() const;
};

/// Expected size of a guide's model after the last pass that records.
struct TreeSize {
    std::uint64_t regions = 0, cells = 0;
    bool with_mixture = false;     ///< histograms from which the fractions of BSDF and tree are learned
    std::uint64_t views = 0;       ///< of T2; their cells are among `cells`
    bool with_lights = false;      ///< next event learns to choose emitters
    SamplerCost cost = {};         ///< of the form that workers sample from
    bool with_next_event = false;  ///< regions decide the number of light samples

    std::uint64_t guide_bytes() const;  ///< bytes of the form that workers sample from
    std::uint64_t sum_bytes() const;    ///< bytes of the plain form and of the sums of records
};

/// Name of the item that a process has in memory when it starts, and its bytes (bench/log/farm.md, "what do the
/// processes of a render take").
inline constexpr const char* kProgramMemory = "program";
inline constexpr std::uint64_t kProgramBytes = std::uint64_t{40} << 20;

/// Bytes of pixels that a worker sends without waiting for its next update: many threads fill much memory in that time.
inline constexpr std::size_t kBundleBytes = std::size_t{24} << 20;

/// Bytes of an emitter, its table apart.
inline constexpr std::uint64_t kEmitterBytes = 128;
/// Approximate bytes and microseconds of the hierarchy per emitter (bench/log/next-event.md, "emitters by what they
/// bring to the point").
inline constexpr std::uint64_t kLightTreeBytes = 180, kLightTreeMicroseconds = 10, kPatchTriangleBytes = 18;
/// Bytes of Embree's hierarchy per triangle, and per other shape with its geometry object, measured
/// (docs/generated/effects.md).
inline constexpr std::uint64_t kHierarchyBytesPerTriangle = 67;
inline constexpr std::uint64_t kHierarchyBytesPerObject = 400;

/// Bytes of a mesh's arrays.
std::uint64_t mesh_bytes(const Mesh& mesh);

/// Bytes of the table by which an emitter is sampled: bound and density per triangle, bound per texel of an environment
/// map.
std::uint64_t emitter_table_bytes(const Scene& scene, const Emitter& emitter);

/// Bytes of the splat sums in a worker, and of their message; 0 for jobs without splats.
std::uint64_t splat_bytes(const Scene& scene, const Resolved& job);

/// Expected size of the tree: a region has about as many vertices as its splitting threshold. A path counts as eight
/// vertices, a region's quadtree as 2.4 / directional_threshold cells, views as their upper bound (one per two
/// regions). Exact for guides that do not grow. 0 without guiding.
TreeSize expected_tree(const Scene& scene, const Resolved& job);

/// Expected memory of a render's processes, as formulas of scene and job. The peak while Embree builds comes on top.
MemoryPlan expected_memory(const Scene& scene, const Resolved& job);

}  // namespace treefarm
