// SPDX-License-Identifier: Apache-2.0
#include "common/config/estimators.h"

#include <algorithm>
#include <iterator>

#include "common/config/job.h"

namespace treefarm {

namespace {

constexpr const char* kCausticsOfPoints =
    "what mirrors, smooth glass and coats throw onto other surfaces from emitters without extent stays dark; "
    "bidirectional and light find it";

constexpr Estimator kEstimators[] = {
    {.type = "path",
     .meaning = "unidirectional path tracing, guided or not",
     .misses_of_points = kCausticsOfPoints,
     .guides = true},
    {.type = "reference",
     .meaning = "unguided path tracing in little code, to check other estimators",
     .misses_of_points = kCausticsOfPoints},
    {.type = "direct",
     .meaning = "direct illumination of the surfaces that the camera sees",
     .depth = 2,
     .by_numbers = true},
    {.type = "normals",
     .meaning = "shading normal n of the surface that the camera sees, as the colour (1 + n) / 2",
     .depth = 1,
     .sees_light = false},
    {.type = "ao",
     .meaning = "ambient occlusion, the share of an even sky that the surface is open to",
     .depth = 2,
     .sees_light = false},
    {.type = "light",
     .meaning = "light tracing, paths from emitters that are connected to the camera: for caustics of small lamps",
     .misses = "what the camera sees in mirrors, through smooth glass or at infinity stays black",
     .from = PathsFrom::lights},
    {.type = "bidirectional",
     .meaning =
         "paths from the camera and from emitters, connected at all vertices: for caustics and lamps in fixtures",
     .misses_of_points = "what mirrors, smooth glass and coats throw from emitters without extent stays dark where the "
                         "camera sees it in mirrors or through smooth glass",
     .from = PathsFrom::both},
};

}  // namespace

std::span<const Estimator> estimators() {
    return kEstimators;
}

const Estimator* find_estimator(std::string_view type) {
    const auto found = std::find_if(std::begin(kEstimators), std::end(kEstimators),
                                    [&](const Estimator& estimator) { return type == estimator.type; });
    return found == std::end(kEstimators) ? nullptr : found;
}

const Estimator& estimator_of(std::string_view type) {
    const Estimator* const found = find_estimator(type);
    return found ? *found : kEstimators[0];
}

const Estimator& estimator_of(const Job& job) {
    return estimator_of(job.integrator.type);
}

}  // namespace treefarm
