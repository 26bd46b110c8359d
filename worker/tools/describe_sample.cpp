// SPDX-License-Identifier: Apache-2.0
#include "worker/tools/describe_sample.h"

#include <sstream>

#include "worker/integrators/path/observe_sample.h"

namespace treefarm {
namespace {

std::ostream& operator<<(std::ostream& out, const Vec3& v) {
    return out << '(' << v.x << ", " << v.y << ", " << v.z << ')';
}

/// Writer of one line of text per event of a path.
class TextEvents : public PathEvents {
  public:
    explicit TextEvents(const TraceScene& scene) : scene_(scene) {}

    std::string text() const { return text_.str(); }

    void camera(const Ray& ray) override {
        text_ << "camera from " << ray.origin << " along " << ray.direction << '\n';
    }
    void arrive(int depth, const Hit* hit) override {
        text_ << "depth " << depth << ": ";
        if (!hit) {
            text_ << "environment\n";
            return;
        }
        const Shape& shape = scene_.geometry().shape(hit->shape);
        text_ << "shape \"" << shape.name << "\" primitive " << hit->primitive << " at " << hit->p << " ng " << hit->ng
              << " ns " << hit->ns << '\n';
    }
    void emission(const Rgb& radiance, float light_pdf, float weight, const Rgb& contribution) override {
        text_ << "  emission " << radiance << " light pdf " << light_pdf << " weight " << weight << " contributes "
              << contribution << '\n';
    }
    void scatter(const SurfacePassage&, const ScatterSample& s, const Rgb& throughput) override {
        text_ << "  scatter " << (s.delta ? "(delta) " : "") << "along " << s.world << " pdf " << s.pdf << " f cos "
              << s.f_cos << " throughput " << throughput << '\n';
    }
    void next_event(const SurfacePassage&, const SampledLight& light, float scatter_pdf, float weight,
                    const Rgb& contribution) override {
        text_ << "  next event along " << light.wi << " distance " << light.distance << " pdf " << light.pdf
              << " scatter pdf " << scatter_pdf << " weight " << weight << " contributes " << contribution << '\n';
    }
    void roulette(float survival, bool survives) override {
        text_ << "  roulette survival " << survival << (survives ? "" : ", lost") << '\n';
    }
    void other_branch(const Ray& ray, const Rgb& throughput) override {
        text_ << "the other way at depth 1: (delta) along " << ray.direction << " throughput " << throughput << '\n';
    }
    void split(std::uint32_t paths, const Rgb& throughput) override {
        text_ << "  splits into " << paths << ", throughput of each " << throughput << '\n';
    }
    void split_path(const SplitPath& path) override {
        text_ << "copy " << int{path.split_budget.number} << " from depth " << path.depth << " throughput "
              << path.throughput << '\n';
    }
    void end(const char* why) override { text_ << "  end: " << why << '\n'; }

  private:
    const TraceScene& scene_;
    std::ostringstream text_;
};

}  // namespace

std::string describe_sample(const TraceScene& scene, const Resolved& job, const PassPlan& pass, const AnySampler& guide,
                            int x, int y, std::uint32_t sample) {
    TextEvents events(scene);
    const Rgb radiance = observe_sample(scene, job, pass, guide, x, y, sample, events);
    std::ostringstream head;
    head.precision(9);
    head << "pass " << pass.index + 1 << " pixel (" << x << ", " << y << ") sample " << sample << " (path sample "
         << pass.first_sample + sample << ") seed " << job.sampler.seed << ": radiance " << radiance << '\n';
    return head.str() + events.text();
}

}  // namespace treefarm
