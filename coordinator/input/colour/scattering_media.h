// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace treefarm {

/// Scattering and absorption coefficients of a medium, per millimetre, in linear Rec. 709. Scattering is reduced by 1 -
/// g to that of an isotropic medium (Jensen et al. 2001, "A practical model for subsurface light transport"; Narasimhan
/// et al. 2006).
struct ScatteringMedium {
    Rgb scattering, absorption;
};

/// The medium of this name in lower case, such as "skin1" or "regular milk"; empty if there is none.
std::optional<ScatteringMedium> find_medium(const std::string& name);

std::vector<std::string> medium_names();

}  // namespace treefarm
