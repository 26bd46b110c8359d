// SPDX-License-Identifier: Apache-2.0
#include "worker/tools/describe_sample.h"

#include <sstream>

#include "worker/guides/walks.h"
#include "worker/integrators/path/path_kernel.h"

namespace treefarm {
namespace {

std::ostream& operator<<(std::ostream& out, const Vec3& v) {
    return out << '(' << v.x << ", " << v.y << ", " << v.z << ')';
}

/// Writes one line per event of a path.
struct TextObserver : NoObserver {
    const TraceScene* scene = nullptr;
    std::ostringstream text;

    void camera(const Ray& ray) { text << "camera from " << ray.origin << " along " << ray.direction << '\n'; }
    void arrive(int depth, const Hit* hit) {
        text << "depth " << depth << ": ";
        if (!hit) {
            text << "environment\n";
            return;
        }
        const Shape& shape = scene->geometry().shape(hit->shape);
        text << "shape \"" << shape.name << "\" primitive " << hit->primitive << " at " << hit->p << " ng " << hit->ng
             << " ns " << hit->ns << '\n';
    }
    void emission(const Rgb& radiance, float light_pdf, float weight, const Rgb& contribution) {
        text << "  emission " << radiance << " light pdf " << light_pdf << " weight " << weight << " contributes "
             << contribution << '\n';
    }
    void scatter(const ScatterSample& s, const Rgb& throughput) {
        text << "  scatter " << (s.delta ? "(delta) " : "") << "along " << s.world << " pdf " << s.pdf << " f cos "
             << s.f_cos << " throughput " << throughput << '\n';
    }
    template <class G>
    void next_event(const PendingLight<G>& light, float scatter_pdf, float weight, const Rgb& contribution) {
        text << "  next event along " << light.wi << " distance " << light.distance << " pdf " << light.pdf
             << " scatter pdf " << scatter_pdf << " weight " << weight << " contributes " << contribution << '\n';
    }
    void roulette(float survival, bool survives) {
        text << "  roulette survival " << survival << (survives ? "" : ", lost") << '\n';
    }
    void other_way(const Ray& ray, const Rgb& throughput) {
        text << "the other way at depth 1: (delta) along " << ray.direction << " throughput " << throughput << '\n';
    }
    void split(std::uint32_t paths, const Rgb& throughput) {
        text << "  goes on as " << paths << ", throughput of each " << throughput << '\n';
    }
    void split_path(const SplitPath& path) {
        text << "copy " << int{path.split_budget.number} << " from depth " << path.depth << " throughput "
             << path.throughput << '\n';
    }
    void end(const char* why) { text << "  end: " << why << '\n'; }
};

template <GuideWalk G, class Surface, bool kGuided>
std::string described(const TraceScene& scene, const Resolved& job, const PassPlan& pass,
                      const typename G::Sampler& guide, int x, int y, const PathKey& path) {
    TraceStats stats;
    PathKernel<G, Surface, kGuided, false, TextObserver> kernel(scene, guide, PathSettings(scene, job, pass, guide),
                                                                stats);
    kernel.observer().scene = &scene;
    kernel.add(path, scene.camera().generate(x, y, path));
    kernel.trace();
    std::ostringstream head;
    head.precision(9);
    head << "pass " << pass.index << " pixel (" << x << ", " << y << ") sample " << path.sample - pass.first_sample
         << " (path sample " << path.sample << ") seed " << path.seed << ": radiance " << kernel.radiance(0) << '\n';
    return head.str() + kernel.observer().text.str();
}

}  // namespace

std::string describe_sample(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const AnySampler& guide,
                            int x, int y, std::uint32_t sample) {
    const PathKey path{job.sampler.seed, scene.film().key_of(x, y), pass.first_sample + sample};
    const KernelChoice& kernel = pass.kernel;
    return guide.visit([&]<class Of>(const auto& sampler) {
        using Walk = WalkOf<typename Of::Sampler>;
        const auto as = [&]<class G, class Surface, bool kGuided>() {
            return described<G, Surface, kGuided>(scene, job, pass, sampler, x, y, path);
        };
        if (!kernel.guided)
            return kernel.plain_diffuse ? as.template operator()<NoGuide, DiffuseSurface, false>()
                                        : as.template operator()<NoGuide, GeneralSurface, false>();
        if (kernel.plain_diffuse) return as.template operator()<Walk, DiffuseSurface, true>();
        return as.template operator()<Walk, GeneralSurface, true>();
    });
}

}  // namespace treefarm
