// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/plan/resolve/resolve.h"

namespace treefarm {

/// Which estimator suits a scene, why, and what it costs: a line for people. Says nothing of estimators that show
/// something else than light. A recommendation: what pays is known once samples were drawn. Pure.
std::string estimator_advice(const Scene& scene, const Resolved& job);

}  // namespace treefarm
