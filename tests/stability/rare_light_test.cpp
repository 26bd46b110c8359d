// SPDX-License-Identifier: Apache-2.0
// Scenes whose light is rare, or hidden, or comes from a weak emitter: what is decided there.
#include "coordinator/input/load.h"
#include "tests/support/hard_case.h"
#include "tests/support/scaled_scene.h"
#include "tests/support/support.h"

namespace treefarm {
namespace {

test::LocalRender decided(const Scene& scene) {
    Job job;
    job.budget.spp = 31;
    job.sampler.seed = 9;
    return test::render_locally(scene, job);
}

/// ours | Decisions where light is rare, at any scale
/// Others: what a first pass has not met stays unknown, and thresholds in scene units decide by the scene's size.
/// Here: guiding, next event and splitting are decided by ratios of what passes measured, relative to the light about a
/// pixel.
/// Holds: a ring in a glass case, a lamp in a glass bulb, a glass of water, two softboxes below a dome that has nearly
/// all of the power, a classroom and a staircase by their windows, each by "auto" at sizes of 2^-10 and 2^10: no sample
/// is invalid, the image has the same bits, and every pass the same decisions.
TEST(RareLight, IsDecidedAlikeAtAnyScale) {
    double rarest = 1;
    for (const char* const name : {"glass-case", "bulb", "water", "softboxes", "classroom", "staircase"}) {
        Scene scene = load_scene(test::own_scene(std::string(name) + ".xml"), {}, false).scene;
        test::set_film(scene, 24, 16);
        const test::LocalRender usual = decided(scene);
        EXPECT_EQ(test::invalid_samples(usual), 0u) << name;
        for (const float factor : {0x1p-10f, 0x1p10f}) {
            const test::LocalRender other = decided(test::scaled(scene, factor));
            test::expect_same_bits(usual, other, 1.0, name + std::to_string(factor));
            ASSERT_EQ(usual.reports.size(), other.reports.size());
            for (std::size_t pass = 0; pass < usual.reports.size(); ++pass) {
                const PassReport &a = usual.reports[pass], &b = other.reports[pass];
                EXPECT_EQ(a.plan.guided, b.plan.guided) << name << ", pass " << pass;
                const auto &verdicts = a.decisions, &scaled = b.decisions;
                EXPECT_EQ(verdicts.get<GuidingDecision::Figures>().guiding,
                          scaled.get<GuidingDecision::Figures>().guiding)
                    << name << ", pass " << pass;
                EXPECT_EQ(verdicts.get<SplittingDecision::Figures>().pays,
                          scaled.get<SplittingDecision::Figures>().pays)
                    << name << ", pass " << pass;
                EXPECT_EQ(a.next_event_samples(), b.next_event_samples()) << name << ", pass " << pass;
            }
        }
        rarest = std::min(rarest, usual.reports.back().next_event_samples());
    }
    EXPECT_LT(rarest, 0.5) << "some of them must have given next event up";
    test::figure("samples of emitters at a vertex, at least", rarest);
}

}  // namespace
}  // namespace treefarm
