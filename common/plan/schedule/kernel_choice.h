// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

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

}  // namespace treefarm
