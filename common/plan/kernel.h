#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/plan/schedule.h"
#include "common/scene/scene.h"

namespace treefarm {

/// Which instance of the path kernel traces a pass. What is not named here (next event, lens, masks, environment,
/// emitter kinds) is decided by the job's and the scene's data.
struct KernelChoice {
    bool plain_diffuse = false;  ///< surfaces without textures, lobes or tilted normals; otherwise all of them
    bool guided = false;
    bool record = false;

    bool operator==(const KernelChoice&) const = default;
    /// "diffuse, guided, recording".
    std::string name() const;
};

/// Kernels in the program.
inline constexpr int kKernelCount = 8;

/// The kernel of one pass.
KernelChoice kernel_of(const Job& job, const PassPlan& pass, bool plain_diffuse);

/// A kernel with the passes that it traces.
struct KernelUse {
    KernelChoice kernel;
    std::vector<std::uint32_t> passes;
};

/// The kernels of a render, in the order in which they come.
std::vector<KernelUse> kernels_of(const Scene& scene, const Job& job);

}  // namespace treefarm
