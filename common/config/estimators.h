// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace treefarm {

struct Job;

/// End of the light transport at which an estimator's paths begin.
enum class PathsFrom : std::uint8_t {
    camera,
    lights,  ///< units are light paths that splat to any pixel; no camera rays
    both,    ///< units are tiles, whose samples also splat to other pixels
};

/// Properties of an estimator for job and plan: the settings of a job that it uses. Its rendering code is in its folder
/// of worker/integrators.
struct Estimator {
    const char* type;              ///< value of integrator.type
    const char* meaning;           ///< for the table of keys
    const char* misses = nullptr;  ///< light missing in its image for any number of samples; nullptr: none
    const char* misses_of_points =
        nullptr;              ///< light missing in addition if emitters without extent shine on mirrors or smooth glass
    int depth = 0;            ///< greatest number of path edges; 0: as the job says
    bool guides = false;      ///< guides may guide its paths, which the path kernels trace
    bool sees_light = true;   ///< false: its image does not depend on emitters
    bool by_numbers = false;  ///< uses integrator.emitter_samples and bsdf_samples
    PathsFrom from = PathsFrom::camera;

    bool has_camera_paths() const { return from != PathsFrom::lights; }
    bool splats() const { return from != PathsFrom::camera; }
};

/// All estimators of the program, the default first.
std::span<const Estimator> estimators();

/// The estimator of this type, or nullptr.
const Estimator* find_estimator(std::string_view type);

/// The estimator of this type; the default one for unknown types, which no worker renders.
const Estimator& estimator_of(std::string_view type);
/// Estimator of a job.
const Estimator& estimator_of(const Job& job);

}  // namespace treefarm
