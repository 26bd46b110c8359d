// SPDX-License-Identifier: Apache-2.0
#include "worker/integrators/path/observe_sample.h"

#include "worker/guides/walks.h"
#include "worker/integrators/path/path_kernel.h"

namespace treefarm {
namespace {

/// Passage of a path through a surface into direction `wi` (shading frame).
template <class Surface>
SurfacePassage passage(const Surface& surface, const Vec3& wi, bool delta) {
    if constexpr (Surface::kGeneral) {
        if (wi.z < 0.0f && !delta) return {surface.eta2() == 1.0f ? PathClass::sheet : PathClass::rough_glass, false};
        if (wi.z < 0.0f)
            return {surface.transmits() ? PathClass::smooth_glass : PathClass::diffuse, true};  // else: null
        if (delta) return {PathClass::mirror, true};
        if (surface.view_dependent()) return {PathClass::glossy, false};
    }
    return {PathClass::diffuse, delta};
}

/// Forwards the walk's events to PathEvents. The walk has one path at a time, so that the events of several are not
/// mixed.
struct EventReporter : NoObserver {
    static constexpr bool kOneByOne = true;

    PathEvents* events = nullptr;

    void camera(const Ray& ray) { events->camera(ray); }
    void arrive(int depth, const Hit* hit) { events->arrive(depth, hit); }
    void emission(const Rgb& radiance, float light_pdf, float weight, const Rgb& contribution) {
        events->emission(radiance, light_pdf, weight, contribution);
    }
    template <class Surface>
    void scatter(const Surface& surface, const ScatterSample& s, const Rgb& throughput) {
        events->scatter(passage(surface, s.local, s.delta), s, throughput);
    }
    template <class Surface, class G>
    void next_event(const Surface& surface, const PendingLight<G>& light, float scatter_pdf, float weight,
                    const Rgb& contribution) {
        events->next_event(passage(surface, surface.frame().to_local(light.wi), false),
                           {light.wi, light.distance, light.pdf, light.from_environment}, scatter_pdf, weight,
                           contribution);
    }
    void roulette(float survival, bool survives) { events->roulette(survival, survives); }
    void other_branch(const Ray& ray, const Rgb& throughput) { events->other_branch(ray, throughput); }
    void split(std::uint32_t paths, const Rgb& throughput) { events->split(paths, throughput); }
    void split_path(const SplitPath& path) { events->split_path(path); }
    void end(const char* why) { events->end(why); }
};

template <GuideWalk G, class Surface, bool kGuided>
Rgb observe(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const typename G::Sampler& guide, int x,
            int y, std::uint32_t sample, PathEvents& events) {
    const PathKey path{job.sampler.seed, scene.film().key_of(x, y), pass.first_sample + sample};
    UnitStats stats;
    PathKernel<G, Surface, kGuided, false, EventReporter> kernel(scene, guide, PathSettings(scene, job, pass, guide),
                                                                 stats);
    kernel.observer().events = &events;
    kernel.add(path, scene.camera().generate(x, y, path));
    kernel.trace();
    return kernel.radiance(0);
}

}  // namespace

Rgb observe_sample(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const AnySampler& guide, int x,
                   int y, std::uint32_t sample, PathEvents& events) {
    const KernelChoice& kernel = pass.kernel;
    return guide.visit([&]<class Of>(const auto& sampler) {
        using Walk = WalkOf<typename Of::Sampler>;
        const auto as = [&]<class G, class Surface, bool kGuided>() {
            return observe<G, Surface, kGuided>(scene, job, pass, sampler, x, y, sample, events);
        };
        if (!kernel.guided)
            return kernel.plain_diffuse ? as.template operator()<NoGuide, DiffuseSurface, false>()
                                        : as.template operator()<NoGuide, GeneralSurface, false>();
        if (kernel.plain_diffuse) return as.template operator()<Walk, DiffuseSurface, true>();
        return as.template operator()<Walk, GeneralSurface, true>();
    });
}

}  // namespace treefarm
