// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/inspected_run.h"
#include "worker/tools/inspect_point.h"

namespace treefarm {

/// A place as a person names it.
struct NamedPoint {
    std::string name;  ///< begins the names of its pictures
    std::string text;  ///< as it was given, for messages
    InspectedPoint point;
};

/// "x,y" of --pixel. Throws InputError where there is no such pixel, or nothing that the tree could be seen at.
NamedPoint named_pixel(const std::string& text, const TraceScene& scene, const AnySampler& guide);

/// "x,y,z" or "x,y,z:nx,ny,nz" of --point. Throws InputError if it lies outside of the tree's cube.
NamedPoint named_point(const std::string& text, const AnySampler& guide);

/// A learned distribution beside true ones.
struct Comparison {
    std::string kind;    ///< "t1", "t2" or "sampled"
    double overlap = 0;  ///< of the learned with the first true one: the integral of the lesser, 1: the same
    double white = 0;    ///< what is shown white, per steradian
    std::string file;    ///< of the picture
    std::vector<std::string> panels;  ///< what it shows, from left to right
};

/// Report of what was seen at a place.
struct PointReport {
    std::string text;
    Vec3 position{0.0f};
    PointFacts facts;
    double reflected = 0;  ///< radiance (mean of the channels) that the surface sends to the pixel, by brute force
    std::vector<Comparison> comparisons;
};

/// Traces the truth at a place and writes its pictures to `folder`.
PointReport inspect_point(const NamedPoint& named, const InspectedRun& run, const TraceScene& scene,
                          const AnySampler& guide, const BruteForce& settings, const std::filesystem::path& folder);

}  // namespace treefarm
