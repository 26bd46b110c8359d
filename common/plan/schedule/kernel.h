// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/guiding/any_guide.h"
#include "common/plan/schedule/schedule.h"

namespace treefarm {

/// Number of kernels in the program: two without guiding, and those of the guides.
inline constexpr int kKernelCount = 2 + Guides::kKernels;

/// Facts about the guide's model at the beginning of a pass.
struct TreeFacts {
    bool trained = false;
    bool has_views = false;
    bool plain_kernels = true;  ///< the guide has kernels for plainly diffuse scenes
};

TreeFacts facts_of(const AnyModel& model);
TreeFacts facts_of(const AnySampler& guide);

/// The kernel of a pass. Pure. Set once per pass by the coordinator; workers use it as it is.
KernelChoice kernel_of(const Resolved& job, const PassPlan& pass, const TreeFacts& tree);

/// Whether a pass's kernel can trace this scene with this tree; the claim of a message may be wrong.
bool fits(const PassPlan& pass, bool plainly_diffuse, const TreeFacts& tree);

/// A kernel with the passes that it traces.
struct KernelUse {
    KernelChoice kernel;
    std::vector<std::uint32_t> passes;
};

/// The kernels of a render, in the order of use; none for estimators without kernels.
std::vector<KernelUse> kernels_of(const Resolved& job);

}  // namespace treefarm
