// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/base/error.h"
#include "coordinator/input/colour/spectra.h"

namespace treefarm::mitsuba {

/// Spectrum from a file of "wavelength value" per line, with # before comments (.spd). Throws InputError if the file is
/// missing, has more than 100,000 lines, a malformed line, wavelengths that do not increase, or fewer than two.
SpectrumSamples read_spectrum_file(const std::filesystem::path& path, const Location& asked_from);

}  // namespace treefarm::mitsuba
