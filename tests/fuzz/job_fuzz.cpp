// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "common/config/job_reader.h"
#include "tests/fuzz/fuzz.h"

using namespace treefarm;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(data, data + size);
    try {
        Job job;
        apply_layer(job, parse_job_settings(text, "input"));
        // What was read is written as text that reads back to the same.
        const std::string written = write_job(job);
        Job back;
        apply_layer(back, parse_job_settings(written, "written"));
        if (write_job(back) != written) std::abort();
    } catch (const InputError&) {
    }
    try {
        Job job;
        const Setting setting = parse_set_argument(text);
        apply_setting(job, setting.key, setting.value, setting.where);
    } catch (const InputError&) {
    }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    return {write_job(Job{}),
            "# sections and dots\n[scene]\nfile = \"../scenes/a.xml\"\nlenient = true\ndefines.size = 64\n"
            "[scene.defines]\n\"odd name\" = 'x'\n[guiding]\npreset = \"paper\"\nspp_unit = 0x10\n"
            "[effects]\nbump = false\nmasks = \"auto\"\n",
            "integrator = { max_depth = 1_000, next_event = \"kickstart\", strict_normals = false }\n"
            "farm.update_seconds = 5e-2\nbudget.spp = 252\nsampler.seed = 18446744073709551615\n",
            "scene.file = \"\"\"a\\\n  b\\u00e9\"\"\"\nscene.defines.date = 1979-05-27T07:32:00Z\n",
            "budget.spp=128",
            "scene.defines.name='x'",
            "a = [[[[[[[[1]]]]]]]]\n"};
}
