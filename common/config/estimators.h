// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace treefarm {

/// An estimator as job and plan see it: which of a job's settings it uses. How it renders stands in its folder of
/// worker/integrators.
struct Estimator {
    const char* type;              ///< value of integrator.type
    const char* meaning;           ///< for the table of keys
    const char* misses = nullptr;  ///< light that its image lacks, whatever the number of samples; nullptr: none
    int depth = 0;                 ///< path edges that it follows at most; 0: as many as the job says
    bool guides = false;           ///< a tree may guide its paths; the path kernels trace them
    bool sees_light = true;        ///< false: its image does not depend on emitters
    bool by_numbers = false;       ///< integrator.emitter_samples and bsdf_samples say how light is found
    bool from_lights = false;      ///< its units are light paths, which splat anywhere; no ray leaves the camera
};

/// All estimators of the program, the usual one first.
std::span<const Estimator> estimators();

/// The estimator of this type, or nullptr.
const Estimator* find_estimator(std::string_view type);

}  // namespace treefarm
