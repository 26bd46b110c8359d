// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace treefarm {

/// Binary PGM and PPM (P5, P6: integers of 8 or 16 bits) and PFM (Pf, PF: floats). Their pixels follow the header as
/// they are.
struct NetpbmHeader {
    int width = 0, height = 0;   ///< pixels, both above 0
    int channels = 0;            ///< 1 or 3
    bool floats = false;         ///< PFM
    int max_value = 0;           ///< PGM, PPM: what stands for 1; above 255 each value has two bytes
    double scale = 0.0;          ///< PFM: negative for the least significant byte first; its size is a factor
    std::size_t data_begin = 0;  ///< offset of the first pixel

    /// Bytes that the pixels take.
    std::uint64_t data_size() const;
};

/// The bytes begin like such a file, or like one in plain text.
bool is_netpbm(std::span<const std::uint8_t> bytes);

/// A file's header. Nothing, and `why`, if it is malformed, or the file in plain text or shorter than the header says.
std::optional<NetpbmHeader> read_netpbm_header(std::span<const std::uint8_t> bytes, std::string& why);

/// The pixels, rows from the top, channels interleaved: bytes of files with 8 bits, else floats (integers from 0 to 1).
/// The file must be as long as the header says.
std::vector<std::uint8_t> netpbm_bytes(std::span<const std::uint8_t> bytes, const NetpbmHeader& header);
std::vector<float> netpbm_floats(std::span<const std::uint8_t> bytes, const NetpbmHeader& header);

}  // namespace treefarm
