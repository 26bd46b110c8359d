// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/base/error.h"
#include "coordinator/input/colour/spectra.h"

namespace treefarm::mitsuba {

/// A file of "wavelength value" per line, # before comments (.spd). Throws InputError: missing, longer than 100,000
/// lines, a line that is no pair of numbers, wavelengths that do not rise, fewer than two.
SpectrumSamples read_spectrum_file(const std::filesystem::path& path, const Location& asked_from);

}  // namespace treefarm::mitsuba
