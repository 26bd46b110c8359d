// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>

#include "worker/geometry/embree_scene.h"
#include "worker/integrators/path/scatter_sample.h"
#include "worker/integrators/path/split_paths.h"
#include "worker/integrators/path/unguided_estimate.h"
#include "worker/lights/light_lanes.h"

namespace treefarm {

/// A path on its way, from the camera to where its ray has just arrived, guided by `G` (guide_walk.h).
template <class G, class Surface>
struct PathState {
    PathKey key;
    std::uint32_t vertex;  ///< by which random numbers are keyed; split paths and other ways have numbers of their own
    int depth;             ///< edges so far
    Ray ray;
    Rgb radiance, throughput;
    float scatter_pdf;             ///< infinite after a delta lobe: next event cannot have found what it hits
    float spread;                  ///< product of eta^2: what refraction took from the throughput and gives back later
    float scatter_light_samples;   ///< of next event at the vertex that the ray left
    std::uint32_t scatter_region;  ///< of that vertex
    float inverse_level;           ///< one over the light about the pixel; 0: not known
    float scatter_bsdf_pdf;        ///< that scattering would have had unguided; infinite after a delta lobe
    UnguidedEstimate unguided;     ///< where PathSettings::twin asks for it
    LightReceiver scatter_from;    ///< the place, as next event chose an emitter there
    LightWidthStore scatter_widths;  ///< of scatter_from
    int first_exponent;              ///< of the quanta where the camera's ray arrived: how bright it is there
    std::uint16_t origin;            ///< the group's camera path that it is part of
    SplitBudget split_budget;
    Unsplit unsplit;
    bool was_split_off;  ///< has just left another: its ray has arrived, and what it met is accounted for

    // Where the ray has arrived; left over from before where it met nothing.
    bool found;
    EmbreeScene::EmbreeHit embree_hit;
    Hit hit;
    typename G::Guidance guidance;                        ///< where the guide is used
    [[no_unique_address]] typename G::Outgoing outgoing;  ///< what the guide keeps of where light leaves to
    std::optional<Surface> surface;
    float light_samples;    ///< of next event here, on average
    bool samples_emitters;  ///< by chance or always
    std::uint8_t lane;      ///< its slot in what the batch has drawn
    typename G::Scatter scatter;
    Rgb weight;  ///< f |cos| over the density of the sampled direction

    void begin(const PathKey& path, const Ray& from_camera) {
        key = path;
        vertex = 0;
        depth = 0;
        split_budget = {};
        unsplit = {};
        was_split_off = false;
        first_exponent = 0;
        ray = from_camera;
        radiance = Rgb(0.0f);
        throughput = Rgb(1.0f);
        scatter_pdf = 0.0f;
        scatter_light_samples = 1.0f;
        scatter_bsdf_pdf = 0.0f;
        unguided = {};
        scatter_region = 0;
        light_samples = 1.0f;
        samples_emitters = true;
        scatter_from = {};
        spread = 1.0f;
        guidance = G::unguided();
    }

    /// Goes on from a delta lobe at the first surface, to add more to the same radiance.
    void resume(const Ray& from_surface, const Rgb& carried, float eta2, std::uint32_t at_vertex) {
        vertex = at_vertex;
        depth = 1;
        ray = from_surface;
        throughput = carried;
        scatter_pdf = scatter_bsdf_pdf = std::numeric_limits<float>::infinity();
        spread = eta2;
    }

    /// Follows the direction that was drawn with its densities, guided and not. Ways out of glass are the same of both.
    void follow_unguided() {
        if (!scatter.delta || scatter.effective_pdf == scatter.pdf) unguided.step(scatter.pdf, scatter.bsdf_pdf);
        scatter_bsdf_pdf = scatter.delta ? std::numeric_limits<float>::infinity() : scatter.bsdf_pdf;
    }

    /// One of the paths that this path goes on as, from where its ray has arrived.
    SplitPath split_off() const {
        return {origin, split_budget, depth, ray, embree_hit, throughput, spread, first_exponent, unguided.split_off()};
    }

    /// Goes on as several, of which it is one, and leaves the others; returns how many they are.
    [[gnu::noinline]] std::uint32_t split(std::uint32_t paths, SplitPaths& others) {
        paths = split_budget.split(paths);
        unsplit.split(paths, luminance(radiance));
        throughput *= 1.0f / static_cast<float>(paths);
        unguided.split(static_cast<float>(paths));
        for (std::uint32_t i = 1; i < paths; ++i)
            others.leave(split_off());
        return paths;
    }

    /// Goes on as one that the path of this key was split into; it adds to a radiance of its own.
    void begin(const PathKey& path, const SplitPath& split) {
        begin(path, split.ray);
        vertex = split.first_vertex();
        depth = split.depth - 1;
        throughput = split.throughput;
        spread = split.spread;
        first_exponent = split.first_exponent;
        origin = split.origin;
        split_budget = split.split_budget;
        was_split_off = true;
        unguided = split.unguided;
        found = true;
        embree_hit = split.embree_hit;
    }
};

}  // namespace treefarm
