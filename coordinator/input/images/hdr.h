// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace treefarm {

/// Header of a Radiance HDR file (RGBE: three mantissas and an exponent per pixel). The decoder is Treefarm's own,
/// since stb's does not terminate on a scan line that is cut short.
struct HdrHeader {
    int width = 0, height = 0;   ///< pixels, both above 0
    std::size_t data_begin = 0;  ///< offset of the first pixel
};

/// Reason for refusing files with runs of whole pixels, as Radiance wrote them before 1991.
inline constexpr const char* kOldHdrRuns = "it is packed by Radiance's old run-length code, which is not read";

/// Whether the bytes begin like a Radiance HDR file.
bool is_hdr(std::span<const std::uint8_t> bytes);

/// Header of an HDR file. Empty, with the reason in `why`, for other formats, colours in XYZ, and rows that do not run
/// from top to bottom and left to right.
std::optional<HdrHeader> read_hdr_header(std::span<const std::uint8_t> bytes, std::string& why);

/// Linear R, G, B of each pixel (mantissa x 2^(exponent - 136)), rows from the top; scan lines may be flat or
/// run-length encoded. Empty, with the reason in `why`, if the pixels are cut short or malformed.
std::optional<std::vector<float>> decode_hdr(std::span<const std::uint8_t> bytes, const HdrHeader& header,
                                             std::string& why);

}  // namespace treefarm
