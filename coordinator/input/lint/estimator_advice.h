// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "common/plan/resolve/resolve.h"

namespace treefarm {

/// Line of text: the estimator that suits a scene, the reason, and the cost. Empty for estimators that show something
/// other than light. Only a recommendation, since the gain is known only after sampling. Pure.
std::string estimator_advice(const Scene& scene, const Resolved& job);

}  // namespace treefarm
