// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/guiding/any_guide.h"
#include "common/plan/resolve/resolve.h"
#include "common/scene/model/scene.h"

namespace treefarm {

/// Bytes that one kind of data is expected to take.
struct MemoryItem {
    std::string name;
    std::uint64_t bytes = 0;
    std::string formula;  ///< one line: how the figure comes about
};

struct MemoryPlan {
    std::vector<MemoryItem> worker;       ///< of one worker process, whatever its threads
    std::vector<MemoryItem> coordinator;  ///< beside its packed copy of the scene, none of it grows with workers

    std::uint64_t worker_bytes() const;
    std::uint64_t coordinator_bytes() const;
};

/// Expected size of a guide's model after the last pass that records.
struct TreeSize {
    std::uint64_t regions = 0, cells = 0;
    bool with_mixture = false;     ///< histograms from which the fractions of BSDF and tree are learned
    std::uint64_t views = 0;       ///< of T2; their cells are among `cells`
    bool with_lights = false;      ///< next event learns how to choose emitters
    SamplerCost cost = {};         ///< of the form that workers sample from
    bool with_next_event = false;  ///< regions decide how often next event samples an emitter

    std::uint64_t guide_bytes() const;  ///< the form that workers sample from
    std::uint64_t sum_bytes() const;    ///< the plain form and the sums of what is recorded
};

/// Bytes that an emitter takes beside its table.
inline constexpr std::uint64_t kEmitterBytes = 128;
/// Bytes and microseconds that the hierarchy takes for each of many emitters, about
/// (bench/log/2026-11-27-light-tree.md).
inline constexpr std::uint64_t kLightTreeBytes = 180, kLightTreeMicroseconds = 10, kPatchTriangleBytes = 18;
/// Embree's hierarchy over triangles, and over other shapes with their geometry objects, measured
/// (docs/generated/effects.md).
inline constexpr std::uint64_t kHierarchyBytesPerTriangle = 67;
inline constexpr std::uint64_t kHierarchyBytesPerObject = 400;

/// Bytes of the arrays of a mesh.
std::uint64_t mesh_bytes(const Mesh& mesh);

/// Bytes of the table by which an emitter is sampled: per triangle a bound and a density, per texel of an environment
/// map a bound.
std::uint64_t emitter_table_bytes(const Scene& scene, const Emitter& emitter);

/// Bytes of the sums of splats in a worker, and of their message; 0 where a job's paths splat nothing.
std::uint64_t splat_bytes(const Scene& scene, const Resolved& job);

/// Expected size of the tree: a region holds about as many vertices as its splitting threshold asks for. A path is
/// counted as eight vertices, a region's quadtree as 2.4 / directional_threshold cells, views as what they are bounded
/// by (one for two regions). Of a guide that does not grow it is known. 0 without guiding.
TreeSize expected_tree(const Scene& scene, const Resolved& job);

/// Memory of the data of a render as formulas of scene and job. Program, libraries, MPI's buffers and the peak while
/// Embree builds come on top.
MemoryPlan expected_memory(const Scene& scene, const Resolved& job);

}  // namespace treefarm
