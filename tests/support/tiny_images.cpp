#include "tests/support/tiny_images.h"

#include <cmath>

namespace treefarm::test {
namespace {

std::string big_endian(std::uint32_t value) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8)
        text += static_cast<char>(value >> shift & 0xff);
    return text;
}

std::string chunk(const std::string& name, const std::string& data) {
    return big_endian(static_cast<std::uint32_t>(data.size())) + name + data + big_endian(0);
}

}  // namespace

std::string TinyPng::bytes() const {
    constexpr char kKinds[] = {0, 0, 4, 2, 6};
    std::string header = big_endian(static_cast<std::uint32_t>(width)) + big_endian(static_cast<std::uint32_t>(height));
    header += static_cast<char>(bits);
    header += kKinds[channels];
    header += std::string(3, '\0');
    std::string rows;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (i % static_cast<std::size_t>(width * channels) == 0) rows += '\0';
        if (bits == 16) rows += static_cast<char>(values[i] >> 8);
        rows += static_cast<char>(values[i] & 0xff);
    }
    // One stored block (RFC 1951, 3.2.4) between zlib's header and its sum.
    const auto size = static_cast<std::uint32_t>(rows.size());
    std::string data = "\x78\x01\x01";
    for (const std::uint32_t word : {size, ~size})
        for (const int shift : {0, 8})
            data += static_cast<char>(word >> shift & 0xff);
    data += rows + big_endian(0);
    std::string file = "\x89PNG\r\n\x1a\n" + chunk("IHDR", header);
    if (gamma > 0.0) file += chunk("gAMA", big_endian(static_cast<std::uint32_t>(std::lround(gamma * 1e5))));
    return file + chunk("IDAT", data) + chunk("IEND", "");
}

std::string tiny_hdr(const std::vector<std::uint8_t>& rgbe) {
    std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X " + std::to_string(rgbe.size() / 4) + "\n";
    file.append(rgbe.begin(), rgbe.end());
    return file;
}

}  // namespace treefarm::test
