// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace treefarm {

/// How a medium scatters and absorbs light, per millimetre, in linear Rec. 709; scattering as if it were isotropic:
/// reduced by 1 - g (Jensen et al. 2001, "A practical model for subsurface light transport"; Narasimhan et al. 2006).
struct ScatteringMedium {
    Rgb scattering, absorption;
};

/// The medium of this name in lower case, "skin1" or "regular milk" for instance; nothing if there is none.
std::optional<ScatteringMedium> find_medium(const std::string& name);

std::vector<std::string> medium_names();

}  // namespace treefarm
