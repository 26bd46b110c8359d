// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/decide/decisions.h"
#include "common/plan/resolve/resolve.h"

namespace treefarm::test {

/// Memories of a job's decisions after a pass of 64 spp that measured that guiding, splitting and light subpaths lose.
inline Decisions::Memories after_losing_pass(const Resolved& job) {
    constexpr std::uint32_t kEdge = 32, kSpp = 64;
    PassPlan plan;
    plan.index = 6;
    plan.spp = plan.first_sample = kSpp;
    plan.record = true;
    TraceCounts counts;
    counts.paths = kEdge * kEdge * kSpp;
    counts.rays = 4 * counts.paths;
    Decisions::Evidence sums;
    std::vector<PixelEstimate> pixels(kEdge * kEdge);
    for (std::uint32_t p = 0; p < kEdge * kEdge; ++p) {
        UnguidedBlock block;
        for (std::uint32_t s = 0; s < kSpp; ++s) {
            const double value = s % 2 == 0 ? 1.5 : 0.5;
            pixels[p].add(s, Rgb(static_cast<float>(value)));
            block.add(value, 1.16, 4.0);
        }
        block.finish(pixel_group(p % kEdge, p / kEdge), sums.get<UnguidedSums>());
    }
    sums.get<SplittingSums>() = {1000, 1000, 1000, 1000};
    sums.get<LightSubpathSums>() = {1000, 1000, 1000, 1000, 1000, 1000};
    JudgedPass pass{.plan = plan, .counts = counts, .rules = decision_rules(job)};
    pass.pixels = pixels;
    pass.width = kEdge;
    pass.told = pass.levels = image_levels(std::vector<Rgb64>(kEdge * kEdge, Rgb64(1.0)), kEdge);
    Decisions::Memories memories;
    Decisions::Figures figures;
    Decisions::judge(pass, sums, memories, figures);
    return memories;
}

/// The plan of a pass as the job's decisions change it after such a pass.
inline PassPlan after_losing_pass(const Resolved& job, PassPlan plan) {
    Decisions::apply(plan, after_losing_pass(job), true);
    return plan;
}

}  // namespace treefarm::test
