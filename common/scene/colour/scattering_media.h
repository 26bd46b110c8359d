// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace treefarm {

/// How a medium scatters and absorbs light, per millimetre, in linear Rec. 709; scattering as if it were isotropic
/// (Jensen et al. 2001, "A practical model for subsurface light transport", figure 5).
struct ScatteringMedium {
    const char* name;
    Rgb scattering, absorption;
};

/// The medium of Mitsuba's name, "skin1" or "ketchup" for instance; nothing if there is none.
std::optional<ScatteringMedium> find_medium(const std::string& name);

std::vector<std::string> medium_names();

}  // namespace treefarm
