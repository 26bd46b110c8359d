// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/decide/light_subpaths/light_subpath_gain.h"
#include "worker/integrators/bidirectional/light_subpath.h"
#include "worker/integrators/bidirectional/sample_connections.h"
#include "worker/integrators/subpath/sensor.h"

namespace treefarm {

/// Tracer of samples over one kind of surface: DiffuseSurface or GeneralSurface.
template <class Surface>
class BidirectionalTracer {
  public:
    BidirectionalTracer(const TraceScene& scene, const Sensor& sensor, const BidirectionalRules& rules,
                        const EmissionChoice& choice, EmissionRecord& record, const PassPlan& pass, UnitOutput& output)
        : scene_(scene),
          sensor_(sensor),
          rules_(rules),
          choice_(choice),
          record_(record),
          first_sample_(pass.first_sample),
          per_usual_(std::ldexp(1.0, -pass.layers.splats.exponent - kSquareBits)),
          stats_(output.stats),
          connections_(scene.geometry(), output),
          light_(scene, rules_, choice, record, output.stats),
          scratch_(Surface::make_scratch(scene)),
          other_(Surface::make_scratch(scene)) {}

    /// Radiance along a camera ray; contributions to other pixels are splatted.
    Rgb radiance(const Numbers auto& numbers, const Ray& camera_ray) {
        // the lens point of the ray
        const Draw camera = draw(numbers, 0, Stream::camera), lens{camera[2], camera[3], 0, 0};
        light_.trace(numbers);
        if (rules_.light_image) connect_to_lens(numbers, lens);
        met_alone_ = 0;
        const std::uint64_t rays = stats_.rays;
        const Rgb met = walk(numbers, camera_ray, lens);
        const SampleConnections::Sums sums = connections_.finish(numbers);
        const Rgb radiance = met + sums.own;
        if (rules_.compare) compare(numbers.sample, radiance, sums, stats_.rays - rays);
        record_.add(light_.emitter(), sums.from_lights * sums.from_lights + sums.splat_squares);
        return radiance;
    }

    /// Ends a unit, after its last sample.
    void finish() { pairs_.finish(stats_.sums<LightSubpathSums>()); }

  private:
    /// Vertex z_(depth) of the camera subpath.
    struct CameraVertex {
        const Hit& hit;
        const Surface& surface;
        Vec3 to_before;  ///< unit
        Rgb throughput;  ///< of light that leaves the vertex, to the camera
        TechniqueSums sums;
        int depth;
    };

    /// State of the camera subpath: its ray and throughput.
    struct Path {
        Ray ray;
        Rgb throughput{1.0f};
        float spread = 1.0f;       ///< product of eta^2: refraction scales the radiance down, and up again on leaving
        Departure from{};          ///< the vertex that the ray left
        TechniqueSums sums{};      ///< of that vertex
        LightReceiver receiver{};  ///< of that vertex, as the choice of an emitter used it
    };

    /// Records the sample's radiance with its light subpath, and its radiance without.
    void compare(std::uint32_t sample, const Rgb& radiance, const SampleConnections::Sums& sums, std::uint64_t rays) {
        if ((sample - first_sample_) % kBlockSamples == 0) pairs_.finish(stats_.sums<LightSubpathSums>());
        pairs_.add({per_usual_ * luminance(radiance), per_usual_ * (met_alone_ + sums.alone), per_usual_ * sums.splats,
                    per_usual_ * per_usual_ * sums.splat_squares});
        stats_.sums<LightSubpathSums>().alone_rays += rays + next_event_rays_;
        next_event_rays_ = 0;
    }

    /// Traces the camera subpath, connects its vertices, and returns the emission that it hits.
    Rgb walk(const Numbers auto& numbers, const Ray& camera_ray, const Draw& lens) {
        Path path{camera_ray};
        Rgb met(0.0f);
        for (int depth = 1;; ++depth) {
            const auto number = static_cast<std::uint32_t>(depth);
            Hit hit;
            const bool found = scene_.geometry().intersect(path.ray, hit);
            ++stats_.rays;
            const Vec3 to_before = -path.ray.direction;
            DrawnEdge edge;
            if (depth > 1) edge = found ? edge_to(path.from, hit, to_before) : edge_to_infinity(path.from);
            if (depth > 1 && !(edge.pdf > 0.0)) return met;
            const TechniqueSums sums = depth > 1 ? path.sums.after(edge, rules_.heuristic)
                                       : found   ? first_sums(hit, to_before, lens)
                                                 : TechniqueSums{};
            add(met, path.throughput, emission(path, sums, found ? &hit : nullptr, depth));

            if (!found || !rules_.goes_on(depth)) return met;
            if (depth > 1 && !rules_.roulette.spares(path.throughput, path.spread, depth - 1,
                                                     to_unit(draw(numbers, number - 1, Stream::roulette)[0])))
                return met;

            scene_.geometry().keep_inside(hit, path.ray);
            const Surface surface(scene_, hit, to_before, scratch_);
            if (surface.black()) return met;
            if (rules_.strict_normals && !normals_agree(surface, to_before, surface.wo().z)) return met;
            ++stats_.vertices;

            const CameraVertex vertex{hit, surface, to_before, path.throughput, sums, depth};
            if (surface.smooth()) {
                next_event(vertex, draw(numbers, number, Stream::light));
                for (int i = 0; i < light_.size() && rules_.goes_on(depth + i + 1); ++i)
                    connect(light_[i], vertex, i + 2);
            }
            if (!scatter(path, vertex, draw(numbers, number, Stream::scatter))) return met;
        }
    }

    /// Adds T light to the sum; adds nothing if the light is black, however large T is.
    static void add(Rgb& sum, const Rgb& throughput, const Rgb& light) {
        if (!is_black(light)) sum += throughput * light;
    }

    /// Sums at the camera subpath's first surface, where the lens may connect to a light subpath.
    TechniqueSums first_sums(const Hit& hit, const Vec3& to_lens, const Draw& lens) const {
        const FilmConnection at = sensor_.importance.connect(hit.p, lens);
        const double pdf = at.g * sensor_.per_window * double(geometric_cosine(hit, to_lens));
        if (!rules_.light_image || !at.seen || !(pdf > 0.0)) return {};
        return {rules_.heuristic(1.0 / pdf), 0.0};
    }

    /// Technique (0, t): emission that the subpath's ray hits.
    Rgb emission(const Path& path, const TechniqueSums& sums, const Hit* arrival, int depth) {
        if (!rules_.techniques.has(0, depth + 1)) return Rgb(0.0f);
        const Rgb light = emitted(scene_.emitters(), path.ray, arrival);
        if (depth == 1) {
            const Rgb seen = rules_.hide_emitters ? Rgb(0.0f) : light;
            met_alone_ += luminance(seen);
            return seen;
        }
        if (is_black(light)) return light;
        const Emitters& emitters = scene_.emitters();
        const Vec3& direction = path.ray.direction;
        const EmissionDensity pdf = arrival ? emitters.emission_density(*arrival, -direction, &choice_)
                                            : emitters.emission_density(direction, &choice_);
        double next_event = 0.0;
        if (rules_.next_event) {
            next_event = double(emitter_pdf(emitters, path.receiver, path.ray, arrival));
            if (arrival)
                next_event *= double(geometric_cosine(*arrival, direction)) / squared_distance(path.from.p, arrival->p);
        }
        if (rules_.compare)
            met_alone_ += luminance(path.throughput * light) *
                          technique_weight(TechniqueSums{sums.join, 0.0}.sum(next_event, 0.0, rules_.heuristic));
        const double others = sums.sum(next_event, double(pdf.position) * double(pdf.direction), rules_.heuristic);
        return light * static_cast<float>(rules_.weight(others));
    }

    /// Technique (1, t): light of a sampled emitter that the surface scatters.
    void next_event(const CameraVertex& z, const Draw& random) {
        if ((!rules_.next_event && !rules_.delta_alone) || !rules_.techniques.has(1, z.depth + 1)) return;
        const Emitters& emitters = scene_.emitters();
        const DirectSample light = rules_.delta_alone ? emitters.sample_delta(z.hit.p, random)
                                                      : emitters.sample_direct(receiver_at(z.hit, z.surface), random);
        if (!(light.pdf > 0.0f) || light.black()) return;
        const BsdfValue bsdf = scattering(z, light.wi);
        if (is_black(bsdf.f_cos)) return;
        const Rgb radiance = light.from_environment ? emitters.environment(light.wi) : light.radiance;
        const Rgb value = z.throughput * bsdf.f_cos * radiance;
        if (is_black(value)) return;
        const double met = light.delta ? 0.0 : rules_.heuristic(double(bsdf.pdf) / double(light.pdf));
        const double weight = rules_.weight(met + next_event_others(z, light, random));
        connections_.add_direct(shadow_ray(z.hit, light), value * static_cast<float>(weight / double(light.pdf)),
                                double(luminance(value)) * technique_weight(met) / double(light.pdf));
        ++next_event_rays_;
    }

    /// Sum over the techniques with a light subpath that could draw this path, relative to next event.
    double next_event_others(const CameraVertex& z, const DirectSample& light, const Draw& random) {
        const EmissionDensity pdf = scene_.emitters().emission_density(light, receiver_at(z.hit, z.surface), random,
                                                                       rules_.delta_alone, &choice_);
        // Densities of the emitter's point and of the direction from it, in next event's measure and per area. If only
        // lights without extent are sampled, both ends are assumed to choose them alike.
        double position = rules_.delta_alone ? 1.0 : double(pdf.position) / double(light.pdf);
        double next = double(pdf.direction) * double(geometric_cosine(z.hit, light.wi));
        if (!light.at_infinity()) {
            const double distance2 = squared_distance(z.hit.p, light.on_light.p);
            next /= distance2;
            const auto cosine = double(geometric_cosine(light.on_light, light.wi));
            // 0 on a sphere's rim, by rounding: no light path leaves along its surface.
            if (!light.delta) position = cosine > 0.0 ? position * (distance2 / cosine) : 0.0;
        }
        return z.sums.sum(position * next, position * next * reverse(z, light.wi), rules_.heuristic);
    }

    /// Technique (s, t): connects a vertex of the light subpath to one of the camera subpath.
    void connect(const LightVertex<Surface>& y, const CameraVertex& z, int s) {
        if (!rules_.techniques.has(s, z.depth + 1) || !y.surface->smooth()) return;
        const double distance2 = squared_distance(y.hit.p, z.hit.p);
        if (!(distance2 > 0.0)) return;
        const Vec3 to_y = Vec3((Imath::V3d(y.hit.p) - Imath::V3d(z.hit.p)) * (1.0 / std::sqrt(distance2)));
        const BsdfValue at_z = scattering(z, to_y);
        if (is_black(at_z.f_cos)) return;
        const LightScattering at_y =
            light_scattering<Surface>(scene_, y.hit, y.in, -to_y, rules_.strict_normals, other_);
        const Rgb value = z.throughput * at_z.f_cos * (y.light * at_y.f);
        if (is_black(value)) return;
        const double y_from_z = double(at_z.pdf) * double(geometric_cosine(y.hit, to_y)) / distance2;
        const double from_y = double(y.surface->bsdf().value(y.surface->wo(), y.surface->frame().to_local(-to_y)).pdf);
        const double z_from_y = from_y * double(geometric_cosine(z.hit, to_y)) / distance2;
        const double others = y.sums.sum(y_from_z, y_from_z * double(at_y.reverse_pdf), rules_.heuristic) +
                              z.sums.sum(z_from_y, z_from_y * reverse(z, to_y), rules_.heuristic);
        const auto factor = static_cast<float>(rules_.weight(others) / distance2);
        connections_.add(ray_between(z.hit, y.hit, to_y), value * factor);
    }

    /// Technique (s, 1): connects vertices of the light subpath to the lens.
    void connect_to_lens(const Numbers auto& numbers, const Draw& lens) {
        for (int i = 0; i < light_.size(); ++i) {
            const LightVertex<Surface>& y = light_[i];
            if (!rules_.techniques.has(i + 2, 1) || !y.surface->smooth() || scene_.geometry().hidden(y.hit.shape))
                continue;
            const FilmConnection to = sensor_.importance.connect(y.hit.p, lens);
            if (!to.seen || !sensor_.pixels.reaches(to.x, to.y)) continue;
            const LightScattering scattering =
                light_scattering<Surface>(scene_, y.hit, y.in, to.direction, rules_.strict_normals, other_);
            const Rgb value = y.light * scattering.f;
            if (is_black(value)) continue;
            const auto vertex = static_cast<std::uint32_t>(i + 1);
            const PixelPick pick = sensor_.pixels.pick(to.x, to.y, draw(numbers, vertex, Stream::filter_pick));
            if (!pick.found) continue;
            const double pdf = to.g * sensor_.per_window * double(geometric_cosine(y.hit, to.direction));
            const double weight =
                rules_.weight(y.sums.sum(pdf, pdf * double(scattering.reverse_pdf), rules_.heuristic));
            connections_.add_splat(ray_to_lens(y.hit, to), value * static_cast<float>(weight * to.g * pick.weight),
                                   pick.pixel, vertex);
        }
    }

    /// BSDF value from a unit direction `from` (world space) to the vertex before.
    BsdfValue scattering(const CameraVertex& z, const Vec3& from) const {
        const Vec3 wi = z.surface.frame().to_local(from);
        const BsdfValue bsdf = z.surface.bsdf().value(z.surface.wo(), wi);
        return rules_.strict_normals && !normals_agree(z.surface, from, wi.z) ? BsdfValue{} : bsdf;
    }

    /// Density with which a light path from direction `from` continues to the vertex before; 0 if no technique needs
    /// it.
    double reverse(const CameraVertex& z, const Vec3& from) {
        return z.sums.beyond > 0.0 ? scatter_pdf<Surface>(scene_, z.hit, from, z.to_before, other_) : 0.0;
    }

    /// Continues the subpath in a direction drawn from the BSDF. False if there is none.
    bool scatter(Path& path, const CameraVertex& z, const Draw& random) {
        const BsdfSample sample = sample_bsdf(z.surface, random);
        if (!(sample.pdf > 0.0f) || is_black(sample.f_cos)) return false;
        const Vec3 direction = z.surface.frame().to_world(sample.wi);
        if (rules_.strict_normals && !normals_agree(z.surface, direction, sample.wi.z)) return false;
        path.throughput *= sample.f_cos * (1.0f / sample.pdf);
        if constexpr (Surface::kTransmits)
            if (sample.wi.z < 0.0f) path.spread *= z.surface.eta2();
        path.from = {z.hit.p, double(geometric_cosine(z.hit, direction)), sample.delta ? 1.0 : double(sample.pdf),
                     sample.delta ? 1.0 : reverse(z, direction), sample.delta};
        path.sums = z.sums;
        path.receiver = receiver_at(z.hit, z.surface);
        path.ray = {offset_origin(z.hit, direction), direction};
        return true;
    }

    const TraceScene& scene_;
    const Sensor& sensor_;
    const BidirectionalRules rules_;
    const EmissionChoice& choice_;
    EmissionRecord& record_;
    const std::uint32_t first_sample_;
    const double per_usual_;  ///< scale by the splats' usual contribution
    UnitStats& stats_;
    SampleConnections connections_;
    LightSubpath<Surface> light_;
    SubpathPairs pairs_;
    /// luminance of emission that the camera subpath hits, weighted without the light path
    double met_alone_ = 0;
    std::uint64_t next_event_rays_ = 0;          ///< of the current sample
    typename Surface::Scratch scratch_, other_;  ///< of the camera vertex, and of a surface seen from another direction
};

}  // namespace treefarm
