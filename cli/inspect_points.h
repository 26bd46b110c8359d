// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/inspected_run.h"
#include "worker/tools/inspect_point.h"

namespace treefarm {

/// A point as the user names it.
struct NamedPoint {
    std::string name;  ///< prefix of its pictures' file names
    std::string text;  ///< the user's text, for messages
    InspectedPoint point;
};

/// Point from "x,y" of --pixel. Throws InputError if there is no such pixel, or no guided surface in it.
NamedPoint named_pixel(const std::string& text, const TraceScene& scene, const AnySampler& guide);

/// Point from "x,y,z" or "x,y,z:nx,ny,nz" of --point. Throws InputError if it is outside the tree's cube.
NamedPoint named_point(const std::string& text, const AnySampler& guide);

/// A learned distribution beside true ones.
struct GuidanceComparison {
    std::string kind;                 ///< "t1", "t2" or "sampled"
    double overlap = 0;               ///< integral of the minimum of the learned and the first true density; 1: equal
    double white = 0;                 ///< density shown as white, per steradian
    std::string file;                 ///< path of the picture
    std::vector<std::string> panels;  ///< titles from left to right
};

/// Results at one point.
struct PointReport {
    std::string text;
    Vec3 position{0.0f};
    PointFacts facts;
    double reflected = 0;  ///< radiance (mean of the channels) from the surface to the pixel, by brute force
    std::vector<GuidanceComparison> comparisons;
};

/// Traces the true distributions at a point and writes its pictures to `folder`.
PointReport inspect_point(const NamedPoint& named, const InspectedRun& run, const TraceScene& scene,
                          const AnySampler& guide, const BruteForce& settings, const std::filesystem::path& folder);

}  // namespace treefarm
