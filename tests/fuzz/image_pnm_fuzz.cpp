// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/image_target.h"
#include "tests/support/plain_images.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    treefarm::fuzz::read_image(data, size);
    return 0;
}

std::vector<std::string> treefarm::fuzz::seeds() {
    return {test::tiny_ppm(), test::tiny_pfm(), "P5 2 1 65535\nabcd"};
}
