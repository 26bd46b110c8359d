// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>

#include "worker/geometry/embree_scene.h"
#include "worker/integrators/path/guided_sampling.h"
#include "worker/integrators/path/path_copies.h"

namespace treefarm {

/// A path on its way, from the camera to where its ray has just arrived.
template <class Surface>
struct PathState {
    PathKey key;
    std::uint32_t vertex;  ///< by which random numbers are keyed; copies and branches have numbers of their own
    int depth;             ///< edges so far
    Ray ray;
    Rgb radiance, throughput;
    float scatter_pdf;  ///< infinite after a delta lobe: next event cannot have found what it meets
    float spread;       ///< product of eta^2: what refraction took from the throughput and gives back later
    Vec3 scatter_point;
    const LightShare* scatter_lights;  ///< how next event chose an emitter there
    bool probe;                        ///< unguided in a pass that probes whether guiding pays
    int first_exponent;                ///< of the quanta where the camera's ray arrived: how bright it is there
    std::uint16_t origin;              ///< the group's camera path that it is part of
    CopyBudget copies;
    Unsplit unsplit;
    bool copied;  ///< has just left another: its ray has arrived, and what it met is accounted for

    // Where the ray has arrived; left over from before where it met nothing.
    bool found;
    EmbreeScene::Meeting meeting;
    Hit hit;
    Guidance guidance;            ///< where the tree is used
    std::uint32_t outgoing_code;  ///< of the direction that light leaves in; where the tree has views
    std::optional<Surface> surface;
    std::uint8_t lane;  ///< its place in what the batch has drawn
    ScatterSample scatter;
    Rgb weight;  ///< f |cos| over the density of the sampled direction

    void begin(const PathKey& path, const Ray& from_camera) {
        key = path;
        vertex = 0;
        depth = 0;
        copies = {};
        unsplit = {};
        copied = false;
        first_exponent = 0;
        ray = from_camera;
        radiance = scatter_point = Rgb(0.0f);
        throughput = Rgb(1.0f);
        scatter_pdf = 0.0f;
        scatter_lights = nullptr;
        spread = 1.0f;
        guidance = {0, Guide::kNoView, 1.0f, 0.0f};
    }

    /// Goes on from a delta lobe at the first surface, to add more to the same radiance.
    void resume(const Ray& from_surface, const Rgb& carried, float eta2, std::uint32_t at_vertex) {
        vertex = at_vertex;
        depth = 1;
        ray = from_surface;
        throughput = carried;
        scatter_pdf = std::numeric_limits<float>::infinity();
        spread = eta2;
    }

    /// A copy of this path, to go on from where its ray has arrived.
    PathCopy copy() const { return {origin, copies, depth, ray, meeting, throughput, spread, first_exponent}; }

    /// Goes on as a copy of the path of this key; it adds to a radiance of its own.
    void begin(const PathKey& path, const PathCopy& copy) {
        begin(path, copy.ray);
        vertex = copy.first_vertex();
        depth = copy.depth - 1;
        throughput = copy.throughput;
        spread = copy.spread;
        first_exponent = copy.first_exponent;
        origin = copy.origin;
        copies = copy.copies;
        copied = true;
        probe = false;
        found = true;
        meeting = copy.meeting;
    }
};

}  // namespace treefarm
