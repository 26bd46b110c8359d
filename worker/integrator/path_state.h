#pragma once

#include <limits>
#include <optional>

#include "worker/geometry/embree_scene.h"
#include "worker/integrator/guided_sampling.h"

namespace treefarm {

/// A path on its way, from the camera to where its ray has just arrived.
template <class Surface>
struct PathState {
    PathKey key;
    Ray ray;
    Rgb radiance, throughput;
    float scatter_pdf;  ///< infinite after a delta lobe: next event cannot have found what it meets
    float spread;       ///< product of eta^2: what refraction took from the throughput and gives back later
    Vec3 scatter_point;
    const LightShare* scatter_lights;  ///< how next event chose an emitter there
    bool probe;                        ///< unguided in a pass that probes whether guiding pays
    int first_exponent;                ///< of the quanta where the camera's ray arrived: how bright it is there

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
        ray = from_camera;
        radiance = scatter_point = Rgb(0.0f);
        throughput = Rgb(1.0f);
        scatter_pdf = 0.0f;
        scatter_lights = nullptr;
        spread = 1.0f;
        guidance = {0, Guide::kNoView, 1.0f, 0.0f};
    }

    /// Goes on from a delta lobe at the first surface, to add more to the same radiance.
    void resume(const Ray& from_surface, const Rgb& carried, float eta2) {
        ray = from_surface;
        throughput = carried;
        scatter_pdf = std::numeric_limits<float>::infinity();
        spread = eta2;
    }
};

}  // namespace treefarm
