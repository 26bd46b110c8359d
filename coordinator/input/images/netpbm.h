// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace treefarm {

/// Header of a binary PGM or PPM (P5, P6: integers of 8 or 16 bits) or PFM (Pf, PF: floats). Uncompressed pixels follow
/// it.
struct NetpbmHeader {
    int width = 0, height = 0;   ///< pixels, both above 0
    int channels = 0;            ///< 1 or 3
    bool floats = false;         ///< PFM
    int max_value = 0;           ///< PGM, PPM: value that stands for 1; above 255, values have two bytes
    double scale = 0.0;          ///< PFM: negative for little-endian order; its magnitude is a factor
    std::size_t data_begin = 0;  ///< offset of the first pixel

    /// Bytes of the pixel data.
    std::uint64_t data_size() const;
};

/// Whether the bytes begin like a PGM, PPM or PFM file, binary or in plain text.
bool is_netpbm(std::span<const std::uint8_t> bytes);

/// Header of a file. Empty, with the reason in `why`, if it is malformed, in plain text, or longer than the file.
std::optional<NetpbmHeader> read_netpbm_header(std::span<const std::uint8_t> bytes, std::string& why);

/// The pixels, rows from the top, channels interleaved: bytes of files with 8 bits, otherwise floats (integers scaled
/// to 0 to 1). The file must be as long as its header says.
std::vector<std::uint8_t> netpbm_bytes(std::span<const std::uint8_t> bytes, const NetpbmHeader& header);
std::vector<float> netpbm_floats(std::span<const std::uint8_t> bytes, const NetpbmHeader& header);

}  // namespace treefarm
