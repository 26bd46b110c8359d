// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm::test {

/// BMP file of 2 x 2 pixels; values from the upper left: 1 2 3, 4 5 6, 7 8 9, 10 11 12.
inline std::string tiny_bmp() {
    std::string bytes =
        "BM" + std::string("\x46\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\x02\0\0\0\x02\0\0\0\x01\0\x18\0", 28);
    bytes.resize(54, '\0');
    return bytes + std::string("\x09\x08\x07\x0c\x0b\x0a\0\0\x03\x02\x01\x06\x05\x04\0\0", 16);
}

/// TGA file of the same pixels with the footer of version 2; packed or not.
inline std::string tiny_tga(bool packed) {
    std::string bytes(18, '\0');
    bytes[2] = packed ? 10 : 2;
    bytes[12] = bytes[14] = 2;
    bytes[16] = 24;
    bytes[17] = 0x20;  // rows from the top
    const std::string pixels("\x03\x02\x01\x06\x05\x04\x09\x08\x07\x0c\x0b\x0a", 12);
    bytes += packed ? "\x03" + pixels : pixels;
    return bytes + std::string(8, '\0') + std::string("TRUEVISION-XFILE.\0", 18);
}

inline std::string tiny_ppm() {
    return "P6\n# comment\n2 2\n255\n\x01\x02\x03\x04\x05\x06\x07\x08\x09\x0a\x0b\x0c";
}

/// PFM file of two rows of one pixel, the upper one 3 4 5, the lower one 0.5 1 2.
inline std::string tiny_pfm() {
    return std::string("PF\n1 2\n-1.0\n") +
           std::string("\0\0\0\x3f\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\0\0\x80\x40\0\0\xa0\x40", 24);
}

}  // namespace treefarm::test
