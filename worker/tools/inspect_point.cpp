// SPDX-License-Identifier: Apache-2.0
#include "worker/tools/inspect_point.h"

#include <array>
#include <atomic>
#include <memory>
#include <thread>

#include "worker/guides/walks.h"
#include "worker/integrators/path/path_kernel.h"

namespace treefarm {
namespace {

/// The middle of all 32-bit numbers, which chooses the middle of a lens or filter.
constexpr std::uint32_t kMiddle = 0x80000000u;

/// BSDF value and density of a point for one direction.
struct Scattering {
    Rgb f_cos{1.0f};     ///< per steradian; 1 for a bare point
    float bsdf_pdf = 0;  ///< per steradian
    bool reflects = true;
};

/// Scattering at the inspected point, one object per thread. A bare point scatters as a diffuse surface if its normal
/// is known, else isotropically.
template <class Surface>
class Scatterer {
  public:
    Scatterer(const TraceScene& scene, const InspectedPoint& point, bool strict_normals)
        : point_(point), strict_(strict_normals), scratch_(Surface::make_scratch(scene)) {
        if (point.surface) surface_.emplace(scene, point.hit, point.outgoing, scratch_);
    }

    const Surface& surface() const { return *surface_; }

    /// Receiver of the point, as next event chooses an emitter for it.
    LightReceiver receiver(const LightProbabilities* learned) const {
        if (!surface_) return {point_.hit.p, learned, point_.normal ? &point_.hit.ns : nullptr};
        const Vec3 front = surface_->front();
        return {point_.hit.p, learned, surface_->transmits() ? nullptr : &front};
    }

    Scattering toward(const Vec3& d) const {
        if (!surface_) {
            if (!point_.normal) return {Rgb(1.0f), 0.25f / kPi, true};
            const float cosine = dot(point_.hit.ns, d);
            return {Rgb(1.0f), std::max(cosine, 0.0f) / kPi, cosine > 0.0f};
        }
        const Vec3 wi = surface_->frame().to_local(d);
        const BsdfValue value = surface_->bsdf().value(surface_->wo(), wi);
        const bool against = strict_ && dot(surface_->ng(), d) * wi.z <= 0.0f;
        return {value.f_cos, value.pdf, !against && !is_black(value.f_cos)};
    }

  private:
    const InspectedPoint& point_;
    const bool strict_;
    typename Surface::Scratch scratch_;
    std::optional<Surface> surface_;
};

/// First emission along a ray from the point, with the densities of next event and of scattering.
struct EmitterHit {
    Rgb emitted{0.0f};
    float light_pdf = 0;  ///< of next event
};

EmitterHit intersect_emitter(const TraceScene& scene, const LightReceiver& from, const Ray& ray) {
    const Emitters& emitters = scene.emitters();
    Hit hit;
    if (!scene.geometry().intersect(ray, hit)) {
        if (!emitters.shines_from_infinity()) return {};
        return {emitters.environment(ray.direction), emitters.pdf_environment(from, ray.direction)};
    }
    if (!emitters.emits(hit.shape)) return {};
    return {emitters.emitted(hit, -ray.direction), emitters.pdf_direct(from, ray.direction, hit)};
}

template <class Surface>
void add_surface_facts(const TraceScene& scene, const InspectedPoint& point, PointFacts& facts) {
    const Scatterer<Surface> scatterer(scene, point, false);
    facts.black = scatterer.surface().black();
    if (facts.black) return;
    facts.smooth = scatterer.surface().smooth();
    if constexpr (Surface::kGeneral) facts.view_dependent = scatterer.surface().view_dependent();
}

/// Properties of a point's surface without any guide.
PointFacts surface_facts(const TraceScene& scene, const InspectedPoint& point) {
    PointFacts facts;
    if (point.surface && scene.plainly_diffuse()) add_surface_facts<DiffuseSurface>(scene, point, facts);
    if (point.surface && !scene.plainly_diffuse()) add_surface_facts<GeneralSurface>(scene, point, facts);
    return facts;
}

/// Surface at the point, in the form that a guide requires.
struct SeenSurface {
    static constexpr bool kGeneral = true;
    bool is_smooth, depends;
    bool smooth() const { return is_smooth; }
    bool view_dependent() const { return depends; }
};

template <GuideWalk G>
typename G::Guidance guidance_at(const typename G::Sampler& guide, const InspectedPoint& point,
                                 const PointFacts& facts) {
    typename G::Guidance guidance = G::unguided();
    guidance.region = guide.region(point.hit.p);
    if (facts.smooth) guidance.bsdf_fraction = guide.bsdf_fraction(guidance.region);
    typename G::Outgoing outgoing{};
    if constexpr (G::kLocal)
        G::template localise<true>(guide,
                                   SeenSurface{facts.smooth, point.surface && facts.smooth && facts.view_dependent},
                                   point.hit.p, point.outgoing, outgoing, guidance);
    return guidance;
}

/// Job of the paths that start at the point: their first edge is the second of a camera path, and emission hit by it is
/// added separately.
Resolved unguided(const Resolved& job) {
    Resolved plain = job;
    plain.guiding.splitting = 1;
    plain.integrator.hide_emitters = true;
    if (plain.integrator.max_depth > 0) --plain.integrator.max_depth;
    return plain;
}

/// Type by which this file compiles kernels of its own. With NoObserver the program would have two copies of each, and
/// the linker could take the renderer's from here, where the compiler inlines less.
struct Unobserved : NoObserver {};

/// Sums over the samples of a square.
struct Square {
    double radiance = 0, left = 0, reflected = 0, left_reflected = 0, sampled = 0;
};

template <GuideWalk G, class Surface>
class PointTracer {
  public:
    PointTracer(const TraceScene& scene, const Resolved& job, const typename G::Sampler& guide,
                const InspectedPoint& point, const BruteForce& settings)
        : scene_(scene),
          guide_(guide),
          point_(point),
          settings_(settings),
          guidance_(guidance_at<G>(guide, point, surface_facts(scene, point))),
          mis_(job.integrator.mis),
          seed_(job.sampler.seed),
          scatterer_(scene, point, job.integrator.strict_normals),
          kernel_(scene, guide, PathSettings(scene, unguided(job), next_event_pass(), guide), stats_) {}

    Square square(std::uint32_t column, std::uint32_t row) {
        Square sums;
        for (std::uint32_t sample = 0; sample < settings_.samples; ++sample) {
            add(column, row, sample, sums);
            if (kernel_.full()) finish(sums);
        }
        finish(sums);
        return sums;
    }

  private:
    static PassPlan next_event_pass() {
        PassPlan pass;
        pass.next_event = true;
        pass.guided = false;
        return pass;
    }

    void add(std::uint32_t column, std::uint32_t row, std::uint32_t sample, Square& sums) {
        const std::uint32_t side = 1u << settings_.bits;
        const PathKey key{seed_, row * side + column, sample};
        const Draw random = draw(key, 0, Stream::camera);
        const Vec2 at((static_cast<float>(column) + to_unit(random[0])) / static_cast<float>(side),
                      (static_cast<float>(row) + to_unit(random[1])) / static_cast<float>(side));
        const Vec3 d = square_to_direction(at);
        const Scattering scattering = scatterer_.toward(d);
        const float pdf = G::pdf(guide_, guidance_, scattering.bsdf_pdf, G::direction_at(at));
        sums.sampled += static_cast<double>(pdf);
        if (!scattering.reflects) return;
        const Ray ray{offset_origin(point_.hit, d), d};
        const EmitterHit emitter =
            intersect_emitter(scene_, scatterer_.receiver(guide_.light_probabilities(guidance_.region)), ray);
        if (!is_black(emitter.emitted)) {
            const double weight = double(mis_weight(mis_, pdf, emitter.light_pdf));
            count(scattering.f_cos, emitter.emitted, 1.0, weight, sums);
        }
        waiting_[kernel_.count()] = scattering.f_cos;
        kernel_.add(key, ray);
    }

    static void count(const Rgb& f_cos, const Rgb& radiance, double all, double left, Square& sums) {
        const double incident = static_cast<double>(average(radiance));
        const double reflected = static_cast<double>(average(f_cos * radiance));
        sums.radiance += all * incident;
        sums.left += left * incident;
        sums.reflected += all * reflected;
        sums.left_reflected += left * reflected;
    }

    void finish(Square& sums) {
        kernel_.trace();
        for (std::uint32_t i = 0; i < kernel_.count(); ++i)
            if (is_finite(kernel_.radiance(i))) count(waiting_[i], kernel_.radiance(i), 1.0, 1.0, sums);
        kernel_.clear();
    }

    const TraceScene& scene_;
    const typename G::Sampler& guide_;
    const InspectedPoint& point_;
    const BruteForce& settings_;
    const typename G::Guidance guidance_;
    const MisHeuristic mis_;
    const std::uint64_t seed_;
    UnitStats stats_;
    Scatterer<Surface> scatterer_;
    using Kernel = PathKernel<NoGuide, Surface, false, false, Unobserved>;
    Kernel kernel_;
    std::array<Rgb, Kernel::kGroup> waiting_;  ///< f |cos| of the directions that the kernel's paths start into
};

template <GuideWalk G, class Surface>
PointTruth trace_with(const TraceScene& scene, const Resolved& job, const typename G::Sampler& guide,
                      const InspectedPoint& point, const BruteForce& settings) {
    const std::uint32_t side = 1u << settings.bits;
    std::vector<Square> squares(std::size_t{side} * side);
    std::atomic<std::uint32_t> next_row = 0;
    const auto work = [&] {
        const auto tracer = std::make_unique<PointTracer<G, Surface>>(scene, job, guide, point, settings);
        for (std::uint32_t row; (row = next_row++) < side;)
            for (std::uint32_t column = 0; column < side; ++column)
                squares[std::size_t{row} * side + column] = tracer->square(column, row);
    };
    std::vector<std::jthread> others;
    for (unsigned k = 1; k < settings.threads; ++k)
        others.emplace_back(work);
    work();
    others.clear();
    const auto mean = [&](double Square::*value) {
        std::vector<float> means;
        for (const Square& square : squares)
            means.push_back(static_cast<float>(square.*value / settings.samples));
        return means;
    };
    PointTruth truth;
    truth.radiance = mean(&Square::radiance);
    if (settings.next_event) truth.left = mean(&Square::left);
    if (point.surface) truth.reflected = mean(&Square::reflected);
    if (point.surface && settings.next_event) truth.left_reflected = mean(&Square::left_reflected);
    truth.sampled = mean(&Square::sampled);
    return truth;
}

}  // namespace

std::optional<InspectedPoint> seen_point(const TraceScene& scene, int x, int y) {
    const Ray ray = scene.camera().generate(x, y, Draw{kMiddle, kMiddle, kMiddle, kMiddle});
    InspectedPoint point;
    if (!scene.geometry().intersect(ray, point.hit)) return std::nullopt;
    point.outgoing = -ray.direction;
    point.surface = point.normal = true;
    return point;
}

PointFacts point_facts(const TraceScene& scene, const AnySampler& guide, const InspectedPoint& point) {
    PointFacts facts = surface_facts(scene, point);
    facts.inside = guide.regions().contains(point.hit.p);
    guide.visit([&]<class G>(const auto& sampler) {
        using Walk = WalkOf<typename G::Sampler>;
        const auto guidance = guidance_at<Walk>(sampler, point, facts);
        facts.guidance.region = guidance.region;
        facts.guidance.bsdf_fraction = guidance.bsdf_fraction;
        if constexpr (std::derived_from<typename Walk::Guidance, ViewTechnique::Local>) {
            const ViewTechnique::Local& view = guidance;
            facts.guidance.view = view.distribution;
            facts.guidance.view_fraction = view.fraction;
        }
    });
    return facts;
}

PointTruth trace_point(const TraceScene& scene, const Resolved& job, const AnySampler& guide,
                       const InspectedPoint& point, const BruteForce& settings) {
    return guide.visit([&]<class G>(const auto& sampler) {
        using Walk = WalkOf<typename G::Sampler>;
        return scene.plainly_diffuse() ? trace_with<Walk, DiffuseSurface>(scene, job, sampler, point, settings)
                                       : trace_with<Walk, GeneralSurface>(scene, job, sampler, point, settings);
    });
}

}  // namespace treefarm
