// SPDX-License-Identifier: Apache-2.0
#include "common/base/error.h"
#include "coordinator/input/mitsuba/colors.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/memory_file.h"

using namespace treefarm;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static fuzz::MemoryFile file;
    file.assign(data, size);
    try {
        mitsuba::read_spectrum_file(file.path(), Location{"scene.xml", 1, 1});
    } catch (const InputError&) {
    }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    return {"# nm value\n400 0.2\n550 0.4\n700 0.6\n", "400 1e-30\r\n401\t2\r\n", "360,1\n830,2\n",
            "400 nan\n500 1e999\n", "\n\n# only comments\n"};
}
