// SPDX-License-Identifier: Apache-2.0
// Renders of real scenes, stopped after each of their passes, written, read and gone on with.
#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

#include "common/base/hash.h"
#include "common/comm/in_process_channel.h"
#include "common/plan/resolve/resolved_file.h"
#include "common/plan/schedule/learning.h"
#include "common/scene/pack/scene_codec.h"
#include "coordinator/checkpoint/checkpoint_store.h"
#include "coordinator/input/load.h"
#include "coordinator/passes/pass_loop.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"
#include "worker/registry.h"
#include "worker/worker_loop.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kFingerprint = 1;

Log render_log() {
    return std::make_shared<spdlog::logger>("test");
}

/// A small scene with a job, and renders of it in this process.
class Stopped {
  public:
    Stopped(const std::string& scene, Job job, const std::string& name)
        : scene_(load_scene(test::own_scene(scene), {}, false).scene), folder_(test::test_folder() / name) {
        scene_.film.width = 24;
        scene_.film.height = 16;
        job.guiding.spatial_threshold = 100;
        job_ = resolve(job, scene_);
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }

    Resolved& job() { return job_; }

    RenderState begin() const { return first_state(job_, first_model(job_, scene_), scene_.film.pixel_count()); }

    /// Goes on with `state` by these passes, writing what it has after each; stops once so many are done.
    RenderResult render(RenderState state, const PassChooser& choose, std::size_t stop_after = ~std::size_t{0}) const {
        auto channels = make_in_process_channels(2);
        std::thread worker([&] {
            run_worker(*channels[1], {.threads = 1, .host = "here", .fingerprint = kFingerprint}, make_renderer,
                       render_log());
        });
        Farm farm(*channels[0], job_, encode_scene(scene_), kFingerprint, render_log());
        farm.gather([] { return false; });
        std::size_t done = state.reports.size();
        CheckpointOrigin origin;
        origin.pixels = scene_.film.pixel_count();
        origin.resolved = write_resolved(job_);
        CheckpointStore store(folder_);
        PassHooks hooks;
        hooks.on_state = [&](RenderState& now) {
            done = now.reports.size();
            store.prepare(origin, now)();
        };
        hooks.interrupted = [&] { return done >= stop_after; };
        RenderResult result =
            run_passes(farm, job_, choose, std::move(state), scene_.film.width, scene_.film.height, hooks);
        dismiss_workers(*channels[0], {}, 20.0);
        worker.join();
        return result;
    }

    RenderState written() const {
        return load_checkpoint(folder_, [](const CheckpointOrigin&) {}).state;
    }

    /// The passes that the job asks for after those of a state.
    PassChooser passes(const RenderState& state) const { return passes_of(job_, state.plans()); }

    RenderResult go_on() const {
        RenderState state = written();
        const PassChooser choose = passes(state);
        return render(std::move(state), choose);
    }

    RenderResult replay(const RenderResult& like) const {
        std::vector<PassPlan> plans;
        for (const PassReport& report : like.passes)
            plans.push_back(report.plan);
        return render(begin(), listed_passes(plans));
    }

  private:
    Scene scene_;
    fs::path folder_;
    Resolved job_;
};

void expect_same(const RenderResult& a, const RenderResult& b, const std::string& what) {
    EXPECT_EQ(hash_text(a.image_hash), hash_text(b.image_hash)) << what;
    EXPECT_EQ(hash_text(a.tree_hash), hash_text(b.tree_hash)) << what;
    EXPECT_EQ(hash_text(a.aov_hash), hash_text(b.aov_hash)) << what;
    ASSERT_EQ(a.passes.size(), b.passes.size()) << what;
    for (std::size_t k = 0; k < a.passes.size(); ++k)
        EXPECT_EQ(a.passes[k].plan, b.passes[k].plan) << what << ", pass " << k;
}

Job job_of(GuidingType type, NextEvent next_event, std::uint32_t spp) {
    Job job;
    job.guiding.type = type;
    job.integrator.next_event = next_event;
    job.budget.spp = spp;
    return job;
}

/// Stops the render after each pass but the last.
void expect_all_stops_same(const std::string& scene, const Job& job, const std::string& name) {
    Stopped render(scene, job, name);
    const RenderResult truth = render.render(render.begin(), render.passes(render.begin()));
    for (std::size_t k = 1; k < truth.passes.size(); ++k) {
        const RenderResult part = render.render(render.begin(), render.passes(render.begin()), k);
        ASSERT_TRUE(part.interrupted);
        expect_same(render.go_on(), truth, name + " stopped after pass " + std::to_string(k));
    }
}

TEST(ResumedRender, EveryGuideGoesOnFromEveryPass) {
    expect_all_stops_same("glossy-room.xml", job_of(GuidingType::none, NextEvent::always, 31), "none");
    expect_all_stops_same("glossy-room.xml", job_of(GuidingType::ppg, NextEvent::never, 31), "ppg");
    expect_all_stops_same("glossy-room.xml", job_of(GuidingType::view, NextEvent::always, 63), "view");
    expect_all_stops_same("diffuse-room.xml", job_of(GuidingType::ppg, NextEvent::kickstart, 255), "kickstart");
}

TEST(ResumedRender, WhatIsLearnedOfNextEventGoesOn) {
    for (const GuidingType type : {GuidingType::none, GuidingType::automatic}) {
        const Job job = job_of(type, NextEvent::automatic, 63);
        Stopped render("bulb.xml", job, "learned");
        const RenderResult truth = render.render(render.begin(), render.passes(render.begin()));
        EXPECT_LT(truth.passes.back().next_event_samples(), 0.9) << int(type);
        expect_all_stops_same("bulb.xml", job, "learned-next-event");
    }
}

TEST(ResumedRender, AVerdictOnGuidingIsTheSame) {
    Job job = job_of(GuidingType::automatic, NextEvent::never, 127);
    job.integrator.rr_depth = 100;
    Stopped render("white-furnace.xml", job, "verdict");
    const RenderResult truth = render.render(render.begin(), render.passes(render.begin()));
    ASSERT_EQ(truth.passes.back().decisions.get<GuidingVerdict>().guiding, Guiding::loses);
    expect_all_stops_same("white-furnace.xml", job, "auto");
}

TEST(ResumedRender, LayersGoOn) {
    Job job = job_of(GuidingType::ppg, NextEvent::always, 15);
    job.output.aovs = "albedo,normal,depth,direct,indirect,spp";
    expect_all_stops_same("cornell-box.xml", job, "layers");
}

TEST(ResumedRender, FoldedPassesGoOn) {
    Job job = job_of(GuidingType::ppg, NextEvent::always, 1023);
    job.guiding.combination = Combination::fixed;
    Stopped render("cornell-box.xml", job, "folded");
    const RenderResult truth = render.render(render.begin(), render.passes(render.begin()));
    ASSERT_GT(truth.passes.size(), 8u);
    render.render(render.begin(), render.passes(render.begin()), 9);
    EXPECT_EQ(render.written().films.size(), 8u);
    expect_same(render.go_on(), truth, "folded");
}

TEST(ResumedRender, ATreeThatWasTheLastOneStaysThat) {
    Stopped render("glossy-room.xml", job_of(GuidingType::view, NextEvent::always, 63), "last-tree");
    render.render(render.begin(), render.passes(render.begin()), 5);
    ASSERT_EQ(render.written().last_tree, true) << "of 63 spp the sixth pass is the last";
    render.job().budget.spp = 255;
    const RenderResult more = render.go_on();
    EXPECT_EQ(more.spp, 255u);
    EXPECT_TRUE(more.passes[5].plan.last_tree && more.passes[5].plan.record);
    expect_same(render.replay(more), more, "by its schedule");
}

TEST(ResumedRender, OneThatIsDoneGrowsAsItsScheduleDoes) {
    Stopped render("glossy-room.xml", job_of(GuidingType::view, NextEvent::always, 31), "grown");
    render.render(render.begin(), render.passes(render.begin()));
    for (const std::uint32_t spp : {100u, 240u}) {
        render.job().budget.spp = spp;
        const RenderResult more = render.go_on();
        EXPECT_EQ(more.spp, spp);
        expect_same(render.replay(more), more, std::to_string(spp));
    }
}

/// The error is reached in a pass that taught: what it taught must not be lost.
TEST(ResumedRender, AnErrorThatIsReachedCanBeMadeSmaller) {
    Job job = job_of(GuidingType::ppg, NextEvent::always, 64);
    job.budget.error = 0.9;
    Stopped render("glossy-room.xml", job, "error");
    const RenderResult rough = render.render(render.begin(), render.passes(render.begin()));
    ASSERT_TRUE(rough.passes.back().plan.record) << "the test needs a render that ends while it learns";
    render.job().budget.error = 0.3;
    const RenderResult fine = render.go_on();
    EXPECT_GT(fine.spp, rough.spp);
    expect_same(render.replay(fine), fine, "by its schedule");
}

}  // namespace
}  // namespace treefarm
