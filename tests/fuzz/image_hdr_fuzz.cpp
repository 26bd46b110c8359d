// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/image_target.h"
#include "tests/support/tiny_images.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    treefarm::fuzz::read_image(data, size);
    return 0;
}

std::vector<std::string> treefarm::fuzz::seeds() {
    const std::string begin = "#?RADIANCE\n# comment\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n";
    // A run of nine, then five and four as they are, twice each.
    const std::string line = std::string("\x02\x02\x00\x09", 4) + "\x89\x80" +
                             "\x05vwxyz\x04"
                             "abcd" +
                             "\x89\x10" + "\x09\x7f\x80\x81\x82\x83\x84\x85\x86\x87";
    return {test::tiny_hdr({128, 64, 32, 129, 1, 2, 3, 0, 255, 255, 255, 255}), begin + "-Y 2 +X 9\n" + line + line,
            begin + "-Y 60000 +X 30000\n" + line, begin + "-Y 1 +X 9\n" + line.substr(0, 8)};
}
