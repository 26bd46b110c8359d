// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "common/guiding/any_guide.h"
#include "common/plan/schedule/schedule.h"

namespace treefarm {

/// Kernels in the program: two that no guide takes part in, and those of guides.
inline constexpr int kKernelCount = 2 + Guides::kKernels;

/// Facts of the guide's model that a pass begins with.
struct TreeFacts {
    bool trained = false;
    bool has_views = false;
    bool plain_kernels = true;  ///< the guide has kernels for plainly diffuse scenes
};

TreeFacts facts_of(const AnyModel& model);
TreeFacts facts_of(const AnySampler& guide);

/// The kernel of one pass. Pure; whoever renders a pass sets it once, and workers take it as it is.
KernelChoice kernel_of(const Resolved& job, const PassPlan& pass, const TreeFacts& tree);

/// Whether a pass's kernel can trace this scene by this tree: a message may say anything.
bool fits(const PassPlan& pass, bool plainly_diffuse, const TreeFacts& tree);

/// A kernel with the passes that it traces.
struct KernelUse {
    KernelChoice kernel;
    std::vector<std::uint32_t> passes;
};

/// The kernels of a render, in the order in which they come; none for an estimator that has no kernels.
std::vector<KernelUse> kernels_of(const Resolved& job);

}  // namespace treefarm
