// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace treefarm {

/// The CIE 1931 standard observer (2 degrees) and the standard illuminant D65 (relative power), per nanometre from 360
/// to 830. Interpolated from tables at 5 nm with a cubic through the four nearest entries; for smooth or piecewise
/// linear spectra, colours agree with tables at 1 nm (Mitsuba 0.6's) to better than 1e-4.
struct CieTables {
    static constexpr int kFirst = 360, kLast = 830;
    static constexpr std::size_t kCount = kLast - kFirst + 1;
    std::array<double, kCount> x, y, z, d65;
};

const CieTables& cie_tables();

}  // namespace treefarm
