// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace treefarm::fuzz {

/// Reads the bytes as a texture and as a picture of `compare`, and aborts if what comes back is not consistent.
void read_image(const std::uint8_t* data, std::size_t size);

}  // namespace treefarm::fuzz
