// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/light_origin.h"
#include "worker/integrators/path/scatter_sample.h"
#include "worker/integrators/path/split_paths.h"

namespace treefarm {

/// Kind of a path's passage at a surface, between two directions.
struct SurfacePassage {
    PathClass path_class = PathClass::diffuse;
    bool delta = false;  ///< of a lobe without density
};

/// A visible emitter that next event sampled.
struct SampledLight {
    Vec3 wi;
    float distance, pdf;
    bool from_environment;
};

/// Observer of the events along one path, in their order (observe_sample()). Split paths follow one after the other, in
/// the order in which they were split off.
class PathEvents {
  public:
    virtual ~PathEvents() = default;
    virtual void camera(const Ray&) {}
    virtual void arrive(int /*depth*/, const Hit*) {}  ///< nullptr: left the scene
    virtual void emission(const Rgb& /*radiance*/, float /*light_pdf*/, float /*weight*/, const Rgb& /*contribution*/) {
    }
    virtual void scatter(const SurfacePassage&, const ScatterSample&, const Rgb& /*throughput*/) {}
    virtual void next_event(const SurfacePassage&, const SampledLight&, float /*scatter_pdf*/, float /*weight*/,
                            const Rgb& /*contribution*/) {}
    virtual void roulette(float /*survival*/, bool /*survives*/) {}
    virtual void other_branch(const Ray&, const Rgb& /*throughput*/) {}  ///< at glass that the camera sees
    virtual void split(std::uint32_t /*paths*/, const Rgb& /*throughput*/) {}
    virtual void split_path(const SplitPath&) {}
    virtual void end(const char* /*why*/) {}
};

}  // namespace treefarm
