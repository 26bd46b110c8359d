// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/guiding/any_guide.h"
#include "common/plan/resolve.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// A point where one looks at what the tree has learned: of a surface as a pixel sees it, or anywhere in the scene.
struct InspectedPoint {
    Hit hit;        ///< of a bare point: `p`, and the normals if they are known
    Vec3 outgoing;  ///< unit, to where light goes; of a surface alone
    bool surface = false;
    bool normal = false;  ///< whether the hit's normals mean something
};

/// The guide at a place, in figures.
struct PointGuidance {
    static constexpr std::uint32_t kNoView = 0xffffffffu;
    std::uint32_t region = 0;
    std::uint32_t view = kNoView;  ///< the distribution of the view there
    float bsdf_fraction = 1.0f;    ///< probability of sampling the BSDF
    float view_fraction = 0.0f;    ///< probability of sampling the view; the rest goes to the region's distribution
    bool has_view() const { return view != kNoView; }
};

/// What the tree uses at a place, and whether the material gives it anything to do.
struct PointFacts {
    PointGuidance guidance;       ///< fractions as the walk uses them; of a bare point: of its region, without view
    bool inside = true;           ///< the tree's cube
    bool black = false;           ///< the surface reflects nothing to there
    bool smooth = true;           ///< it has a lobe that a tree can learn about
    bool view_dependent = false;  ///< it has one that T2 learns about, too
};

/// The place that the centre of a pixel sees (through the centre of a lens); nothing if it sees no surface.
std::optional<InspectedPoint> seen_point(const TraceScene& scene, int x, int y);

PointFacts point_facts(const TraceScene& scene, const AnySampler& guide, const InspectedPoint& point);

/// How the truth is found: by path tracing from the place, with next event, without guides.
struct BruteForce {
    int bits = 6;                ///< 2^bits by 2^bits squares of the direction square
    std::uint32_t samples = 64;  ///< per square
    unsigned threads = 1;
    bool next_event = false;  ///< whether the passes that taught the tree sampled emitters
};

/// Averages over the squares of the direction square, in row order from v = 0. Radiance is the mean of its channels, as
/// the tree records it; directions in which the surface reflects nothing (or below the normal) are 0. What is `left` is
/// what next event leaves to scattering: emission that is met directly counts by its MIS weight.
struct PointTruth {
    std::vector<float> radiance;        ///< incident: all of it
    std::vector<float> left;            ///< of it; empty if next event took no part
    std::vector<float> reflected;       ///< f |cos| times incident radiance; empty without a surface
    std::vector<float> left_reflected;  ///< of it; empty if next event took no part
    std::vector<float> sampled;         ///< density per steradian of the smooth part of what the walk samples here
};

/// Traces what a place scatters and receives. Pure but for its time: the same numbers for any number of threads.
PointTruth trace_point(const TraceScene& scene, const Resolved& job, const AnySampler& guide,
                       const InspectedPoint& point, const BruteForce& settings);

}  // namespace treefarm
