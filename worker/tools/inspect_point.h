// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/guiding/any_guide.h"
#include "common/plan/resolve/resolve.h"
#include "worker/scene/trace_scene.h"

namespace treefarm {

/// Point at which the learned distribution is inspected: a surface point seen by a pixel, or any point of the scene.
struct InspectedPoint {
    Hit hit;        ///< of a bare point: `p`, and the normals if known
    Vec3 outgoing;  ///< unit, direction that light goes to; of a surface point only
    bool surface = false;
    bool normal = false;  ///< whether the hit's normals are valid
};

/// Guidance at the inspected point.
struct PointGuidance {
    static constexpr std::uint32_t kNoView = 0xffffffffu;
    std::uint32_t region = 0;
    std::uint32_t view = kNoView;  ///< distribution of the view at the point
    float bsdf_fraction = 1.0f;    ///< probability of sampling the BSDF
    float view_fraction = 0.0f;    ///< probability of sampling the view; the rest is that of the region's distribution
    bool has_view() const { return view != kNoView; }
};

/// Data that the tree uses at the point, and which lobes the material has.
struct PointFacts {
    PointGuidance guidance;       ///< fractions as the walk uses them; of a bare point: of its region, without a view
    bool inside = true;           ///< the point is within the tree's cube
    bool black = false;           ///< the surface reflects nothing in the outgoing direction
    bool smooth = true;           ///< it has a lobe with a density, which guides can learn
    bool view_dependent = false;  ///< it has a lobe that depends on the outgoing direction, for T2
};

/// Surface point at the centre of a pixel, seen through the lens's centre; no value without a surface.
std::optional<InspectedPoint> seen_point(const TraceScene& scene, int x, int y);

PointFacts point_facts(const TraceScene& scene, const AnySampler& guide, const InspectedPoint& point);

/// Settings of the reference measurement: path tracing from the point, with next event, without guides.
struct BruteForce {
    int bits = 6;                ///< 2^bits by 2^bits squares of the direction square
    std::uint32_t samples = 64;  ///< per square
    unsigned threads = 1;
    bool next_event = false;  ///< whether the passes that taught the tree sampled emitters
};

/// Averages over the squares of the direction square, in row order from v = 0. Radiance is the mean of its channels, as
/// the tree records it; 0 in directions that the surface does not reflect (or below the normal). `left`: the part that
/// next event leaves to scattering, with emission that is hit weighted by MIS.
struct PointTruth {
    std::vector<float> radiance;        ///< incident radiance
    std::vector<float> left;            ///< part of it left to scattering; empty without next event
    std::vector<float> reflected;       ///< f |cos| times incident radiance; empty without a surface
    std::vector<float> left_reflected;  ///< part of it left to scattering; empty without next event
    std::vector<float> sampled;         ///< density per steradian of the smooth lobes' samples at the point
};

/// Traces the point's incident and reflected light. Deterministic for any number of threads.
PointTruth trace_point(const TraceScene& scene, const Resolved& job, const AnySampler& guide,
                       const InspectedPoint& point, const BruteForce& settings);

}  // namespace treefarm
