// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace treefarm {

/// Where an estimator's paths begin.
enum class PathsFrom : std::uint8_t {
    camera,
    lights,  ///< its units are light paths, which splat anywhere; no ray leaves the camera
    both,    ///< its units are tiles, and bring something to other pixels, too
};

/// An estimator as job and plan see it: which of a job's settings it uses. How it renders stands in its folder of
/// worker/integrators.
struct Estimator {
    const char* type;              ///< value of integrator.type
    const char* meaning;           ///< for the table of keys
    const char* misses = nullptr;  ///< light that its image lacks, whatever the number of samples; nullptr: none
    const char* misses_of_points = nullptr;  ///< where emitters without extent shine on mirrors or smooth glass
    int depth = 0;                           ///< path edges that it follows at most; 0: as many as the job says
    bool guides = false;                     ///< a tree may guide its paths; the path kernels trace them
    bool sees_light = true;                  ///< false: its image does not depend on emitters
    bool by_numbers = false;                 ///< integrator.emitter_samples and bsdf_samples say how light is found
    PathsFrom from = PathsFrom::camera;

    bool has_camera_paths() const { return from != PathsFrom::lights; }
    bool splats() const { return from != PathsFrom::camera; }
};

/// All estimators of the program, the usual one first.
std::span<const Estimator> estimators();

/// The estimator of this type, or nullptr.
const Estimator* find_estimator(std::string_view type);

/// The estimator of this type; the usual one where there is none such, which no worker then renders.
const Estimator& estimator_of(std::string_view type);

}  // namespace treefarm
