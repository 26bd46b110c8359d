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

/// State of a path from the camera to its ray's present hit, guided by `G` (guide_walk.h).
template <class G, class Surface>
struct PathState {
    PathKey key;
    std::uint32_t vertex;  ///< keys the random numbers; split paths and other branches have ranges of their own
    int depth;             ///< edges so far
    Ray ray;
    Rgb radiance, throughput;
    float scatter_pdf;  ///< infinite after a delta lobe: next event cannot have sampled that direction
    /// product of eta^2, by which refraction has scaled the throughput; undone on leaving
    float spread;
    float scatter_light_samples;     ///< number of light samples at the vertex that the ray left
    std::uint32_t scatter_region;    ///< of that vertex
    float inverse_level;             ///< one over the light about the pixel; 0: unknown
    float scatter_bsdf_pdf;          ///< density of the same direction without guiding; infinite after a delta lobe
    UnguidedEstimate unguided;       ///< if PathSettings::estimates_unguided is set
    LightReceiver scatter_from;      ///< the vertex that the ray left, as the choice of an emitter used it
    LightWidthStore scatter_widths;  ///< storage of scatter_from
    int first_exponent;              ///< of the quanta at the camera ray's hit: the scale of its brightness
    std::uint16_t origin;            ///< index of its camera path in the group
    SplitBudget split_budget;
    Unsplit unsplit;
    bool was_split_off;  ///< just split off: its ray has arrived, and the emission there is counted already

    // Data of the ray's hit; stale if it hit nothing.
    bool found;
    EmbreeScene::EmbreeHit embree_hit;
    Hit hit;
    typename G::Guidance guidance;                        ///< if the guide is used
    [[no_unique_address]] typename G::Outgoing outgoing;  ///< the guide's form of the outgoing direction
    std::optional<Surface> surface;
    float light_samples;    ///< average number of light samples at this vertex
    bool samples_emitters;  ///< whether this vertex samples emitters
    std::uint8_t lane;      ///< index in the batch's random numbers
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

    /// Continues from a delta lobe at the first surface, and adds to the same radiance.
    void resume(const Ray& from_surface, const Rgb& carried, float eta2, std::uint32_t at_vertex) {
        vertex = at_vertex;
        depth = 1;
        ray = from_surface;
        throughput = carried;
        scatter_pdf = scatter_bsdf_pdf = std::numeric_limits<float>::infinity();
        spread = eta2;
    }

    /// Updates the unguided estimate for the drawn direction, by its guided and unguided density. The choice of the way
    /// out of glass is the same for both.
    void follow_unguided() {
        if (!scatter.delta || scatter.effective_pdf == scatter.pdf) unguided.step(scatter.pdf, scatter.bsdf_pdf);
        scatter_bsdf_pdf = scatter.delta ? std::numeric_limits<float>::infinity() : scatter.bsdf_pdf;
    }

    /// State of a path that is split off at the present hit.
    SplitPath split_off() const {
        return {origin, split_budget, depth, ray, embree_hit, throughput, spread, first_exponent, unguided.split_off()};
    }

    /// Splits the path into several, of which it remains one; the others go to `others`. Returns the total number.
    [[gnu::noinline]] std::uint32_t split(std::uint32_t paths, SplitPaths& others) {
        paths = split_budget.split(paths);
        unsplit.split(paths, luminance(radiance));
        throughput *= 1.0f / static_cast<float>(paths);
        unguided.split(static_cast<float>(paths));
        for (std::uint32_t i = 1; i < paths; ++i)
            others.leave(split_off());
        return paths;
    }

    /// Starts a split path under its key, with a radiance of its own.
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
