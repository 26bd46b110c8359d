// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "worker/integrators/path/pending_light.h"
#include "worker/integrators/path/scatter_sample.h"
#include "worker/integrators/path/split_paths.h"

namespace treefarm {

/// Observer without any effect or cost. observe_sample() passes one that reports events.
struct NoObserver {
    static constexpr bool kOneByOne = false;  ///< whether a kernel walks one path at a time

    void camera(const Ray&) {}
    void ray(const Ray&) {}
    void shadow(const Ray&) {}
    void arrive(int, const Hit*) {}
    void emission(const Rgb&, float, float, const Rgb&) {}
    template <class Surface>
    void scatter(const Surface&, const ScatterSample&, const Rgb&) {}
    template <class Surface, class G>
    void next_event(const Surface&, const PendingLight<G>&, float, float, const Rgb&) {}
    void roulette(float, bool) {}
    void other_branch(const Ray&, const Rgb&) {}
    void split(std::uint32_t, const Rgb&) {}
    void split_path(const SplitPath&) {}
    void end(const char*) {}
};

}  // namespace treefarm
