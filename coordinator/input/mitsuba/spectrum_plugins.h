// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "coordinator/input/mitsuba/properties.h"

namespace treefarm::mitsuba {

/// Colour of an object of Mitsuba 2 and 3 that stands for a spectrum: uniform, rawconstant, srgb, d65 (without a
/// texture inside), regular, irregular, blackbody. Empty for other types. As in Mitsuba's RGB variants if these have
/// the plugin; regular, irregular and blackbody exist in spectral variants only and become Rgb like lists.
std::optional<Rgb> read_spectrum_plugin(Properties& properties, ColorUse use, Diagnostics& diagnostics);

}  // namespace treefarm::mitsuba
