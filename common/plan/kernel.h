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
    bool views = false;  ///< with the tree's view-dependent part

    bool operator==(const KernelChoice&) const = default;
    /// "diffuse, guided, recording".
    std::string name() const;
};

/// Kernels in the program.
inline constexpr int kKernelCount = 11;

/// The kernel of one pass. `views`: the tree has views.
KernelChoice kernel_of(const Job& job, const PassPlan& pass, bool plain_diffuse, bool views);

/// Whether the tree begins with views: the job asks for them, and a surface of the scene depends on them.
bool learns_views(const Scene& scene, const Job& job);

/// A kernel with the passes that it traces.
struct KernelUse {
    KernelChoice kernel;
    std::vector<std::uint32_t> passes;
};

/// The kernels of a render, in the order in which they come.
std::vector<KernelUse> kernels_of(const Scene& scene, const Job& job);

}  // namespace treefarm
