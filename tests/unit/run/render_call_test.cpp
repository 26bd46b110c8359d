// SPDX-License-Identifier: Apache-2.0
// A render as a call of the library: no command, no terminal, no MPI.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <vector>

#include "common/base/error.h"
#include "common/image/exr.h"
#include "coordinator/render/resume.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"
#include "worker/local_worker.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

void work(Channel& own) {
    run_local_worker(own, 1, Fingerprint().hash(), make_log("worker", {}, TellMessage()));
}

class RenderCall : public ::testing::Test {
  protected:
    const fs::path folder_ = test::fresh_test_folder();

    RenderInput input(const std::string& folder = "run") const {
        return {.file = test::own_scene("glossy-room.xml"),
                .settings = {{"scene.defines.width", "24", {}},
                             {"scene.defines.height", "16", {}},
                             {"guiding.spatial_threshold", "200", {}},
                             {"output.directory", (folder_ / folder).string(), {}}},
                .budget = {.spp = 31}};
    }

    static RenderRequest runnable(RenderRequest request) {
        request.workers.local = work;
        return request;
    }
};

TEST_F(RenderCall, AsksForAnImageByASceneAndSettings) {
    RenderRequest request = read_request(input());
    request.workers.local = work;
    const RenderOutcome outcome = render(request);

    EXPECT_EQ(outcome.state, RunState::done);
    EXPECT_EQ(outcome.error, "");
    EXPECT_EQ(outcome.folder, folder_ / "run");
    EXPECT_TRUE(outcome.resumable);
    EXPECT_EQ(outcome.result.spp, 31u);
    EXPECT_TRUE(outcome.result.error.known);
    const std::vector<Rgb64>& image = outcome.result.image->mean;
    ASSERT_EQ(image.size(), 24u * 16u);
    EXPECT_TRUE(std::any_of(image.begin(), image.end(), [](const Rgb64& mean) { return mean.x > 0; }));
    const RgbImage file = read_exr_rgb((outcome.folder / "image.exr").string()).image;
    for (std::size_t k = 0; k < image.size(); ++k)
        EXPECT_EQ(file.pixels[k].y, static_cast<float>(image[k].y)) << "pixel " << k;
}

TEST_F(RenderCall, TellsItsObserverOfPassesProgressAndMessages) {
    std::vector<PassReport> passes;
    std::vector<LifePhase> phases;
    std::set<MessageLevel> levels;
    std::vector<std::string> infos;
    std::size_t workers = 0;
    int ends = 0;
    RenderObserver observer;
    observer.message = [&](MessageLevel level, const std::string& text) {
        levels.insert(level);
        if (level == MessageLevel::info) infos.push_back(text);
    };
    observer.phase = [&](LifePhase phase) { phases.push_back(phase); };
    observer.progress = [&](const RenderProgress& progress, const Roster& roster) {
        EXPECT_EQ(progress.pass, passes.size());
        workers = std::max(workers, roster.present_count());
    };
    observer.pass = [&](const PassReport& pass, const CombinedImage& image) {
        passes.push_back(pass);
        EXPECT_EQ(image.mean.size(), 24u * 16u);
    };
    observer.end = [&](const RenderOutcome& outcome) {
        ++ends;
        EXPECT_EQ(outcome.state, RunState::done);
    };
    const RenderOutcome outcome = render(runnable(read_request(input())), observer);

    ASSERT_EQ(passes.size(), 5u) << "1 2 4 8 16";
    ASSERT_EQ(outcome.result.passes.size(), passes.size());
    EXPECT_EQ(passes.back().spp_done, 31u);
    EXPECT_EQ(outcome.result.passes.back().error.rmse, passes.back().error.rmse);
    EXPECT_EQ(workers, 1u);
    EXPECT_EQ(ends, 1);
    EXPECT_EQ(phases.front(), LifePhase::gather);
    EXPECT_EQ(phases.back(), LifePhase::write);
    EXPECT_TRUE(levels.contains(MessageLevel::detail));
    ASSERT_FALSE(infos.empty());
    EXPECT_TRUE(infos.front().starts_with("rendering glossy-room, 24 x 16, 31 spp in 5 passes; results in "))
        << infos.front();
}

TEST_F(RenderCall, StopsBetweenPassesAndGoesOnToTheSameBits) {
    const RenderOutcome whole = render(runnable(read_request(input("whole"))));

    RenderRequest request = runnable(read_request(input()));
    bool stop = false;
    request.workers.stop = [&] { return stop; };
    RenderObserver observer;
    observer.pass = [&](const PassReport& pass, const CombinedImage&) { stop = pass.spp_done == 7; };
    const RenderOutcome broken_off = render(request, observer);
    EXPECT_EQ(broken_off.state, RunState::interrupted);
    EXPECT_TRUE(broken_off.resumable);
    EXPECT_EQ(broken_off.result.spp, 7u);

    const RenderOutcome resumed = render(runnable(read_resumed(broken_off.folder, {}, {})));
    EXPECT_EQ(resumed.state, RunState::done);
    EXPECT_EQ(resumed.result.spp, 31u);
    EXPECT_EQ(resumed.result.image_hash, whole.result.image_hash);
    EXPECT_EQ(resumed.result.tree_hash, whole.result.tree_hash);
}

TEST_F(RenderCall, FindsWhatItsFolderHoldsAlready) {
    RenderRequest request = runnable(read_request(input()));
    EXPECT_FALSE(go_on_in_folder(request).has_value());
    ASSERT_EQ(render(request).state, RunState::done);
    RenderRequest again = runnable(read_request(input()));
    const auto there = go_on_in_folder(again);
    ASSERT_TRUE(there.has_value());
    EXPECT_EQ(there->state, RunState::done);
    EXPECT_EQ(there->folder, folder_ / "run");
}

TEST_F(RenderCall, RefusesBadInputByAnExceptionThatNamesThePlace) {
    RenderInput unknown = input();
    unknown.settings.push_back({"budget.samples", "3", {"here"}});
    EXPECT_THROW(read_request(unknown), InputError);
    EXPECT_THROW(read_request({.file = "scene.obj"}), InputError);
    EXPECT_THROW(read_resumed(folder_ / "nowhere", {}, {}), InputError);
    RenderInput twice = input();
    twice.budget.seconds = 3;
    EXPECT_THROW(read_request(twice), InputError);
}

TEST_F(RenderCall, LeavesAnotherRendersFolderAsItIs) {
    ASSERT_EQ(render(runnable(read_request(input()))).state, RunState::done);
    const auto written = fs::last_write_time(folder_ / "run" / "summary.json");
    RenderObserver observer;
    observer.end = [](const RenderOutcome&) { FAIL() << "it did not begin"; };
    EXPECT_THROW(render(runnable(read_request(input())), observer), InputError);
    EXPECT_EQ(fs::last_write_time(folder_ / "run" / "summary.json"), written);
}

TEST_F(RenderCall, NeedsWorkers) {
    EXPECT_THROW(render(read_request(input())), std::exception);
    EXPECT_FALSE(fs::exists(folder_ / "run"));
}

}  // namespace
}  // namespace treefarm
