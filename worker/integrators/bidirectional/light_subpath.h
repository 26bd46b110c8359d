// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>

#include "worker/integrators/bidirectional/edge.h"
#include "worker/integrators/bidirectional/rules.h"
#include "worker/integrators/subpath/emission_record.h"

namespace treefarm {

/// Surface vertex of a light subpath, ready to be connected.
template <class Surface>
struct LightVertex {
    Hit hit;
    Vec3 in{0.0f};    ///< unit, towards the light's origin
    Rgb light{0.0f};  ///< arriving light over the density of the path
    TechniqueSums sums;
    typename Surface::Scratch scratch;
    std::optional<Surface> surface;  ///< as the light subpath samples it

    explicit LightVertex(const TraceScene& scene) : scratch(Surface::make_scratch(scene)) {}
};

/// Light subpath of a sample: its vertices y1, y2, ... that are not black. The emitter, y0, is not stored: next event
/// connects emitters better.
template <class Surface>
class LightSubpath {
  public:
    using Vertex = LightVertex<Surface>;

    LightSubpath(const TraceScene& scene, const BidirectionalRules& rules, const EmissionChoice& choice,
                 EmissionRecord& record, TraceStats& stats)
        : scene_(scene),
          rules_(rules),
          choice_(choice),
          record_(record),
          stats_(stats),
          scratch_(Surface::make_scratch(scene)) {}

    /// Traces a light subpath: each vertex has its own random numbers, the emitter 0, surfaces from 1 on.
    void trace(const Numbers auto& numbers) {
        count_ = 0;
        emitter_ = 0;
        if (!rules_.goes_on(1)) return;
        const EmissionSample start = scene_.emitters().emit(draw(numbers, 0, Stream::light_start),
                                                            draw(numbers, 0, Stream::light_scatter), &choice_);
        emitter_ = start.entry;
        if (start.from != EmissionFrom::nothing) record_.start(emitter_);
        if (!is_black(start.weight)) walk(start, numbers);
    }

    /// Emitter at the start of the path, an entry of EmissionChoice; 0 if there is none.
    std::uint32_t emitter() const { return emitter_; }
    int size() const { return count_; }
    /// Vertex y_(i + 1).
    const Vertex& operator[](int i) const { return vertices_[static_cast<std::size_t>(i)]; }

  private:
    void walk(const EmissionSample& start, const Numbers auto& numbers) {
        Ray ray = start.ray;
        Rgb throughput(1.0f);  // since the emitter
        Departure from;
        for (int depth = 1;; ++depth) {
            const auto number = static_cast<std::uint32_t>(depth);
            Vertex& vertex = next_slot();
            ++stats_.rays;
            if (!scene_.geometry().intersect(ray, vertex.hit)) return;
            if (depth > 1 && !rules_.roulette.spares(throughput, 1.0f, depth - 1,
                                                     to_unit(draw(numbers, number - 1, Stream::light_roulette)[0])))
                return;
            scene_.geometry().keep_inside(vertex.hit, ray);
            vertex.in = -ray.direction;
            vertex.light = start.weight * throughput;
            const Surface& surface = vertex.surface.emplace(scene_, vertex.hit, vertex.in, vertex.scratch);
            if (surface.black()) return;
            if (depth == 1) {
                vertex.sums = first_sums(start, vertex.hit, surface);
            } else {
                const DrawnEdge edge = edge_to(from, vertex.hit, vertex.in);
                if (!(edge.pdf > 0.0)) return;
                vertex.sums = vertices_[static_cast<std::size_t>(count_ - 1)].sums.after(edge, rules_.heuristic);
            }
            ++count_;
            ++stats_.vertices;
            if (!rules_.goes_on(depth + 1)) return;
            const LightStep step = scatter_light(scene_, vertex.hit, surface, vertex.in, rules_.strict_normals,
                                                 draw(numbers, number, Stream::light_scatter), scratch_);
            if (!step.goes_on) return;
            throughput *= step.weight;
            from = {vertex.hit.p, double(geometric_cosine(vertex.hit, step.direction)),
                    step.delta ? 1.0 : double(step.pdf), step.delta ? 1.0 : double(step.reverse_pdf), step.delta};
            ray = {offset_origin(vertex.hit, step.direction), step.direction};
        }
    }

    /// Sums over the techniques that draw this path's emitter by next event, or hit it.
    TechniqueSums first_sums(const EmissionSample& start, const Hit& hit, const Surface& surface) const {
        const Heuristic& m = rules_.heuristic;
        const double pdf = double(start.position_pdf) * start.next_pdf(hit.p, hit.ng);
        if (!(pdf > 0.0)) return {};
        double sampled = 0.0;
        if (rules_.next_event)
            sampled = scene_.emitters().next_event_pdf(start, receiver_at(hit, surface));
        else if (start.is_delta())
            sampled = double(start.position_pdf);  // equal to the assumption in BidirectionalTracer
        return {m(sampled / pdf), m(start.position_factor(hit.p) / pdf)};
    }

    /// Storage for the next vertex. Vertices keep their addresses, since surfaces point to their hits.
    Vertex& next_slot() {
        if (static_cast<std::size_t>(count_) == vertices_.size()) vertices_.emplace_back(scene_);
        return vertices_[static_cast<std::size_t>(count_)];
    }

    const TraceScene& scene_;
    const BidirectionalRules& rules_;
    const EmissionChoice& choice_;
    EmissionRecord& record_;
    TraceStats& stats_;
    typename Surface::Scratch scratch_;  ///< of surfaces as the camera subpath sees them
    std::deque<Vertex> vertices_;        ///< reused from sample to sample
    int count_ = 0;
    std::uint32_t emitter_ = 0;
};

}  // namespace treefarm
