// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Instance of the path kernel for a pass. Properties not listed here (next event, lens, masks, environment, emitter
/// kinds) depend on data of job and scene.
struct KernelChoice {
    bool plain_diffuse = false;  ///< surfaces without textures, lobes or tilted normals; otherwise all surfaces
    bool guided = false;
    bool record = false;
    bool views = false;  ///< uses the tree's view-dependent part

    bool operator==(const KernelChoice&) const = default;
    /// Name for people: "diffuse, guided, recording".
    std::string name() const;
};

}  // namespace treefarm
