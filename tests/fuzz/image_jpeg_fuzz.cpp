// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/image_target.h"
#include "tests/support/tiny_images.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    treefarm::fuzz::read_image(data, size);
    return 0;
}

std::vector<std::string> treefarm::fuzz::seeds() {
    using test::tiny_jpeg;
    std::string progressive = tiny_jpeg(24, 20, 3, 95);  // in name only, but its way through the decoder is another
    progressive[progressive.find("\xff\xc0") + 1] = '\xc2';
    std::string huge = tiny_jpeg(8, 8, 1, 20);
    huge.replace(huge.find("\xff\xc0") + 5, 4, 4, '\xff');
    // Found by libFuzzer: stb wrote past its table while it looked for the size.
    std::string sizeless = tiny_jpeg(9, 7, 3, 95);
    sizeless.replace(sizeless.find("\xff\xc4") + 5, 16, 16, '\xff');
    sizeless[sizeless.find("\xff\xc0")] = '\0';
    return {tiny_jpeg(9, 7, 3, 95), tiny_jpeg(20, 18, 3, 60), tiny_jpeg(8, 8, 1, 20), progressive, huge, sizeless};
}
