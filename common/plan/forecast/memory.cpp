// SPDX-License-Identifier: Apache-2.0
#include "common/plan/forecast/memory.h"

#include <algorithm>
#include <cmath>

#include "common/film/splat_film.h"
#include "common/guiding/statistics/cell_sums.h"
#include "common/plan/forecast/film_memory.h"
#include "common/plan/schedule/kernel.h"
#include "common/plan/schedule/learning.h"
#include "common/plan/schedule/schedule.h"
#include "common/scene/uses/emitter_uses.h"
#include "common/scene/uses/texture_mean.h"

namespace treefarm {
namespace {

/// Vertices per path in closed rooms; fewer where light leaves the scene or the job ends paths early.
constexpr double kVerticesPerPath = 8.0;
/// Mean records of a region after the last split, as a part of its threshold: measured in the scenes of configs/.
constexpr double kRegionFilling = 0.65;
/// Cells per region times the directional threshold, also measured; fewer where cells follow use.
constexpr double kCellsPerRegion = 2.4;
constexpr double kCellsPerRegionByUse = 2.0;

/// Views per region in a scene that learns views.
constexpr double kViewsPerRegion = 0.5;
/// Bytes of a cell's sum (docs/design/guiding.md).
constexpr std::uint64_t kSumBytes = 8;
/// Bytes of both halves of a pixel's splats.
constexpr std::uint64_t kSplatBytes = 2 * sizeof(SplatMoments);
constexpr std::uint64_t kPlainTreeBytesPerCell = 5;
constexpr std::uint64_t kPlainTreeBytesPerRegion = 2 * 8 + 6;

std::uint64_t total(const std::vector<MemoryItem>& items) {
    std::uint64_t bytes = 0;
    for (const MemoryItem& item : items)
        bytes += item.bytes;
    return bytes;
}

std::string count_text(std::uint64_t count, const char* what) {
    return std::to_string(count) + " " + what;
}

std::uint64_t geometry_bytes(const Scene& scene) {
    std::uint64_t bytes = scene.shapes.size() * sizeof(Shape);
    for (const Shape& shape : scene.shapes)
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) bytes += mesh_bytes(*mesh);
    return bytes;
}

std::uint64_t texture_bytes(const Scene& scene) {
    std::uint64_t bytes = scene.textures.size() * sizeof(Texture);
    for (const TextureImage& image : scene.images)
        bytes += image_bytes(image);
    return bytes;
}

std::uint64_t emitters_bytes(const Scene& scene) {
    std::uint64_t bytes = 0;
    for (const Emitter& emitter : scene.emitters)
        bytes += kEmitterBytes + emitter_table_bytes(scene, emitter);
    return bytes;
}

/// Numbers of the entries that next event chooses among by position: emitters, patches of meshes, parts of images.
struct LightParts {
    std::uint64_t count = 0;
    std::uint64_t cut_triangles = 0;  ///< of meshes in patches
};
LightParts light_parts(const Scene& scene) {
    constexpr std::uint64_t kFewTriangles = 16, kPatchTriangles = 8, kMostPatches = 128, kImageParts = 8;
    LightParts parts;
    for (const Emitter& emitter : scene.emitters) {
        std::uint64_t count = 1;
        for_each_image(emitter, [&](std::int32_t) { count = kImageParts; });
        if (const auto* area = std::get_if<AreaEmitter>(&emitter.kind); area && area->shape != kNone) {
            const auto* mesh = std::get_if<Mesh>(&scene.shapes[static_cast<std::size_t>(area->shape)].geometry);
            if (const std::uint64_t triangles = mesh ? mesh->triangle_count() : 0; triangles > kFewTriangles) {
                count = std::min(triangles / kPatchTriangles, kMostPatches);
                parts.cut_triangles += triangles;
            }
        }
        parts.count += count;
    }
    return parts;
}

/// Memory of the tables by which next event chooses emitters, their own tables apart.
MemoryItem emitter_item(const Scene& scene, const Resolved& job) {
    const std::uint64_t count = scene.emitters.size();
    MemoryItem item{"emitters", emitters_bytes(scene), count_text(count, "emitters")};
    const LightSelection how = job.integrator.light_selection;
    if (job.integrator.next_event == NextEvent::never || !job.scene_facts.chooses_lights) return item;
    if (how == LightSelection::power || how == LightSelection::even) {
        item.formula += how == LightSelection::power ? ", chosen by power" : ", all chosen alike";
        return item;
    }
    item.formula += ", chosen by what they bring to a point";
    if (how == LightSelection::learned) item.formula += " and what regions learn";
    const LightParts parts = light_parts(scene);
    if (parts.count <= static_cast<std::uint64_t>(kLightClusters)) return item;
    item.bytes += parts.count * kLightTreeBytes + parts.cut_triangles * kPatchTriangleBytes;
    item.formula += "; a hierarchy of at most " + count_text(parts.count, "parts, built in about ") +
                    std::to_string(std::max<std::uint64_t>(parts.count * kLightTreeMicroseconds / 1000, 1)) + " ms";
    return item;
}

}  // namespace

std::uint64_t mesh_bytes(const Mesh& mesh) {
    std::uint64_t attributes = 0;
    for (const MeshAttribute& attribute : mesh.attributes)
        attributes += sizeof(MeshAttribute) + attribute.values.size() * sizeof(Rgb);
    return mesh.positions.size() * sizeof(Vec3) + mesh.normals.size() * sizeof(Vec3) + mesh.uvs.size() * sizeof(Vec2) +
           mesh.indices.size() * sizeof(std::uint32_t) + attributes;
}

std::uint64_t emitter_table_bytes(const Scene& scene, const Emitter& emitter) {
    struct : IgnoreFields {
        const Scene* scene;
        std::uint64_t bytes = 0;
        void shape(std::int32_t index) {
            if (index == kNone) return;
            const auto* mesh = std::get_if<Mesh>(&scene->shapes[static_cast<std::size_t>(index)].geometry);
            bytes += mesh ? 12 * mesh->triangle_count() : 0;
        }
        void image(std::int32_t index) {
            const TextureImage& image = scene->images[static_cast<std::size_t>(index)];
            bytes += 6 * static_cast<std::uint64_t>(image.width) * static_cast<std::uint64_t>(image.height + 1);
        }
    } table;
    table.scene = &scene;
    visit_fields(emitter.kind, table);
    return table.bytes;
}

std::uint64_t splat_bytes(const Scene& scene, const Resolved& job) {
    const bool splats = make_pass(job, 0, 0, 1, true).layers.splats.pixels > 0;
    return splats ? 2 * scene.film.pixel_count() * kSplatBytes : 0;
}

std::uint64_t TreeSize::guide_bytes() const {
    return regions * (cost.region + (with_lights ? sizeof(LightProbabilities) : 0) + (with_next_event ? 1 : 0)) +
           views * cost.view + cells * cost.cell;
}

std::uint64_t TreeSize::sum_bytes() const {
    return (regions + views) * kPlainTreeBytesPerRegion +
           (with_lights ? regions * (sizeof(LightProbabilities) + kLightClusters * kSumBytes) : 0) +
           (with_mixture ? (regions + views) * kMixtureBins * kSumBytes : 0) +
           (with_next_event ? regions * (1 + kNextEventSums * kSumBytes) : 0) +
           cells * (kPlainTreeBytesPerCell + kSumBytes);
}

std::uint64_t MemoryPlan::worker_bytes() const {
    return total(worker);
}

std::uint64_t MemoryPlan::coordinator_bytes() const {
    return total(coordinator);
}

TreeSize expected_tree(const Scene& scene, const Resolved& job) {
    if (!job.guides) return {};
    const std::vector<PassPlan> passes = plan_passes(job);
    const bool with_mixture =
        std::any_of(passes.begin(), passes.end(), [](const PassPlan& pass) { return pass.learn_mixture; });
    const AnyModel first = first_model(job, Box3(), 1.0f);
    if (!first.grows()) {
        const ModelFigures size = first.figures();
        return {size.regions,      size.cells,   with_mixture,          size.views,
                job.learns_lights, first.cost(), job.decides_next_event};
    }
    const int depth = job.integrator.max_depth;
    const double length = depth < 0 ? kVerticesPerPath : std::min(kVerticesPerPath, std::max(depth - 1.0, 0.0));
    const auto pixels = static_cast<double>(scene.film.pixel_count());
    double regions = 1.0;
    for (std::size_t k = 0; k + 1 < passes.size(); ++k) {
        const double vertices = length * pixels * passes[k].spp;
        regions = std::max(regions, vertices / (kRegionFilling * spatial_split_threshold(job, passes[k + 1])));
    }
    const double views = job.learns_views ? kViewsPerRegion * regions : 0.0;
    const double region_cells = job.cells_follow_use ? kCellsPerRegionByUse : kCellsPerRegion;
    const double cells =
        (region_cells * regions + kCellsPerRegion * views) / static_cast<double>(job.guiding.directional_threshold);
    return {static_cast<std::uint64_t>(regions),
            static_cast<std::uint64_t>(cells),
            with_mixture,
            static_cast<std::uint64_t>(views),
            job.learns_lights,
            first.cost(),
            job.decides_next_event};
}

MemoryPlan expected_memory(const Scene& scene, const Resolved& job) {
    const std::uint64_t triangles = scene.triangle_count();
    std::uint64_t objects = 0;
    for (const Shape& shape : scene.shapes)
        objects += std::holds_alternative<Mesh>(shape.geometry) ? 0 : 1;
    const TreeSize tree = expected_tree(scene, job);
    const std::string tree_text = count_text(tree.regions, "regions, ") +
                                  (tree.views > 0 ? count_text(tree.views, "views, ") : "") +
                                  count_text(tree.cells, "cells");

    MemoryPlan plan;
    plan.worker.push_back({"geometry", geometry_bytes(scene), count_text(triangles, "triangles, as arrays")});
    plan.worker.push_back({"hierarchy", kHierarchyBytesPerTriangle * triangles + kHierarchyBytesPerObject * objects,
                           count_text(kHierarchyBytesPerTriangle, "bytes per triangle, ") +
                               count_text(kHierarchyBytesPerObject, "per other shape")});
    plan.worker.push_back(
        {"materials", scene.materials.size() * sizeof(Material), count_text(scene.materials.size(), "materials")});
    plan.worker.push_back({"textures", texture_bytes(scene), count_text(scene.images.size(), "images")});
    plan.worker.push_back(emitter_item(scene, job));
    plan.worker.push_back({"tree", tree.guide_bytes() + tree.sum_bytes(), tree_text});
    const MemoryItem splats{"splats", splat_bytes(scene, job),
                            count_text(kSplatBytes, "bytes a pixel: sums, and their message")};
    if (splats.bytes > 0) plan.worker.push_back(splats);
    const std::uint64_t scene_bytes = geometry_bytes(scene) + texture_bytes(scene);
    plan.coordinator.push_back({"scene", 2 * scene_bytes, "as values and packed for workers"});
    add_film_memory(scene, job, plan);
    if (splats.bytes > 0) plan.coordinator.push_back(splats);
    plan.coordinator.push_back({"tree", 2 * tree.sum_bytes(), tree_text + ", before and after refinement"});
    for (std::vector<MemoryItem>* items : {&plan.worker, &plan.coordinator})
        items->push_back({kProgramMemory, kProgramBytes, "program, libraries and MPI of a process"});
    return plan;
}

}  // namespace treefarm
