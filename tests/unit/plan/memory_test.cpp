// SPDX-License-Identifier: Apache-2.0
#include "common/plan/forecast/memory.h"

#include <gtest/gtest.h>

#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

/// Peak resident sizes in MiB of cornell-box with three ranks of one thread (bench/log/farm.md, "what do the processes
/// of a render take").
TEST(Plan, MemoryIsWhatProcessesTake) {
    struct Measured {
        int size;
        std::uint32_t spp;
        const char* aovs;
        double worker, coordinator;
    };
    for (const Measured& m :
         {Measured{512, 1, "", 57, 152}, Measured{512, 7, "", 72, 369}, Measured{512, 15, "", 78, 421},
          Measured{1024, 1, "", 0, 428}, Measured{2048, 1, "", 77, 1796}, Measured{4096, 1, "", 96, 7479},
          Measured{512, 3, "albedo,normal,depth,direct", 0, 445}}) {
        Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
        scene.film.width = scene.film.height = m.size;
        Job job;
        job.budget.spp = m.spp;
        job.output.aovs = m.aovs;
        const MemoryPlan plan = expected_memory(scene, resolve(job, scene));
        constexpr double kMiB = 1 << 20;
        const double worker = static_cast<double>(plan.worker_bytes()) / kMiB;
        const double coordinator = static_cast<double>(plan.coordinator_bytes()) / kMiB;
        if (m.worker > 0) {
            EXPECT_NEAR(worker / m.worker, 1, 0.2) << m.size << " " << m.spp;
        }
        EXPECT_NEAR(coordinator / m.coordinator, 1, 0.2) << m.size << " " << m.spp;
    }
}

}  // namespace
}  // namespace treefarm
