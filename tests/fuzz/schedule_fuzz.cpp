// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "common/base/error.h"
#include "common/plan/schedule/schedule_file.h"
#include "tests/fuzz/fuzz.h"

using namespace treefarm;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(data, data + size);
    for (const GuidingType type : {GuidingType::none, GuidingType::ppg}) {
        Job asked;
        asked.guiding.type = type;
        const Resolved job = resolve(asked, SceneFacts{});
        try {
            const std::vector<PassPlan> passes = parse_schedule(text, "input", job);
            // What was read is written as text that reads back to the same.
            if (parse_schedule(write_schedule(passes), "written", job) != passes) std::abort();
        } catch (const InputError&) {
        }
    }
    return 0;
}

std::vector<std::string> fuzz::seeds() {
    Job asked;
    asked.budget.spp = 300;
    const Resolved job = resolve(asked, SceneFacts{});
    return {write_schedule(plan_passes(job)), "[[pass]]\nspp = 4\nnext_event = true\nrecord = true\n",
            "[[pass]]\nspp = 1073741824\nnext_event = false\nrecord = false\n",
            "pass = [{ spp = 1, next_event = true, record = false }]\n"};
}
