// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/plan/resolve/resolve.h"

namespace treefarm {

/// An estimator that may suit a scene.
struct EstimatorAdvice {
    std::string type;    ///< of integrator.type
    std::string reason;  ///< in words
};

/// Estimator to be tried for a scene, by rays between lamps and what is seen. Only a guess: the gain is known after
/// sampling. Pure.
EstimatorAdvice estimator_advice(const Scene& scene, const Resolved& job);

}  // namespace treefarm
