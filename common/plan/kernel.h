#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/plan/schedule.h"
#include "common/scene/scene.h"

namespace treefarm {

/// Which instance of the path kernel traces a pass. What is not named here (lens, masks, environment, emitter kinds)
/// is decided by the scene's data outside of the kernel.
struct KernelChoice {
    bool plain_diffuse = false;  ///< surfaces without textures, lobes or tilted normals; otherwise all of them
    bool next_event = false;
    bool guided = false;
    bool record = false;

    bool operator==(const KernelChoice&) const = default;
    /// "diffuse, next event, guided, recording".
    std::string name() const;
};

/// Kernels in the program.
inline constexpr int kKernelCount = 12;

/// The kernel of one pass; `sampled_emitters` says whether the scene has any that next event can sample.
KernelChoice kernel_of(const Job& job, const PassPlan& pass, bool plain_diffuse, bool sampled_emitters);

/// A kernel with the passes that it traces.
struct KernelUse {
    KernelChoice kernel;
    std::vector<std::uint32_t> passes;
};

/// The kernels of a render, in the order in which they come.
std::vector<KernelUse> kernels_of(const Scene& scene, const Job& job);

}  // namespace treefarm
