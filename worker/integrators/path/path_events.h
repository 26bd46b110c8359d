// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/film/light_origin.h"
#include "worker/integrators/path/scatter_sample.h"
#include "worker/integrators/path/split_paths.h"

namespace treefarm {

/// A surface's part in a path: what light passes there that goes from one direction to another.
struct SurfacePassage {
    PathClass path_class = PathClass::diffuse;
    bool delta = false;  ///< of a lobe without density
};

/// An emitter that next event sampled, and that is seen.
struct SampledLight {
    Vec3 wi;
    float distance, pdf;
    bool from_environment;
};

/// What happens along one path, in its order, for whoever wants to know (observe_sample()). Paths that it is split into
/// come one after the other, in the order in which they were left.
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
    virtual void other_branch(const Ray&, const Rgb& /*throughput*/) {}  ///< of glass before the camera
    virtual void split(std::uint32_t /*paths*/, const Rgb& /*throughput*/) {}
    virtual void split_path(const SplitPath&) {}
    virtual void end(const char* /*why*/) {}
};

}  // namespace treefarm
