// SPDX-License-Identifier: Apache-2.0
#include "coordinator/study/study.h"
#include "tests/fuzz/fuzz.h"

using namespace treefarm;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const Study study = parse_study(std::string(data, data + size), "/nowhere/study.toml");
        // Every cell names what there is.
        for (const StudyCell& cell : study_cells(study))
            if (cell.scene >= study.scenes.size() || cell.method >= study.methods.size()) __builtin_trap();
    } catch (const InputError&) {
    }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    const std::string scene = "[scene.box]\nfile = \"/dev/null\"\nimage.width = 32\n";
    const std::string rest = "[budget]\nspp = 8\n[reference]\nsampler.seed = 1000\n";
    return {
        scene + rest,
        "seeds = [5, 7]\nwarmup = 0\nbaseline = \"zebra\"\n" + scene +
            "[method.zebra]\n[method.ape]\nguiding.type = \"none\"\n" + rest,
        scene + rest + "[vary]\nguiding.spp_unit = [1, 4]\nfarm.tile_size = [8, 16, 32]\n",
        scene + "[budget]\nseconds = 1.5\n[job]\nintegrator.next_event = \"never\"\n[output]\ndirectory = \"runs/x\"\n",
        "seeds = 18446744073709551615\n" + scene + rest};
}
