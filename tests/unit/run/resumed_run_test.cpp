// SPDX-License-Identifier: Apache-2.0
// Folders of renders that go on, and of shots: what in them changes when.
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "coordinator/render/render.h"
#include "coordinator/shot/shot_run.h"
#include "tests/support/test_folder.h"
#include "tests/support/test_scenes.h"
#include "worker/local_worker.h"
#include "worker/registry.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

const LocalWorker kWorker = [](Channel& own) {
    run_local_worker(own, 1, Fingerprint().hash(), make_log("worker", {}, TellMessage()));
};

class Folders : public ::testing::Test {
  protected:
    fs::path folder_ = test::fresh_test_folder() / "run";

    RenderRequest request(std::uint32_t spp, double checkpoint_seconds = 1e-3) const {
        RenderRequest request;
        request.content.job.scene.file = "/nowhere/box.xml";
        request.content.job.guiding.type = GuidingType::none;
        request.content.job.budget.spp = spp;
        request.content.job.farm.checkpoint_seconds = checkpoint_seconds;
        request.content.job.farm.memory_check = false;
        request.content.job.output.directory = folder_.string();
        request.content.scene = test::cornell_box(1.0f, Vec3(0.0f));
        test::set_film(request.content.scene, 8, 8);
        request.content.plan = plan_effects(request.content.scene, request.content.job);
        request.workers.local = kWorker;
        return request;
    }

    LoadedCheckpoint load() const {
        return load_checkpoint(folder_, [](const CheckpointOrigin&) {});
    }

    RenderRequest more(std::uint32_t spp, double checkpoint_seconds = 1e-3) const {
        RenderRequest wanted = request(spp, checkpoint_seconds);
        wanted.start.checkpoint = std::make_shared<LoadedCheckpoint>(load());
        return wanted;
    }

    /// `stop`: whether the render is interrupted, asked again and again.
    static RunState render(
        RenderRequest request, const std::function<bool()>& stop = [] { return false; },
        const RenderObserver& observer = {}) {
        request.workers.stop = stop;
        return treefarm::render(request, observer).state;
    }

    /// The files of the folder by name.
    std::map<std::string, std::string> files() const {
        std::map<std::string, std::string> texts;
        for (const auto& entry : fs::directory_iterator(folder_))
            if (entry.is_regular_file()) texts[entry.path().filename().string()] = test::read_file(entry.path());
        return texts;
    }
};

TEST_F(Folders, ARenderThatNeverGoesOnChangesNothingButItsStatus) {
    ASSERT_EQ(render(request(3)), RunState::done);
    const auto before = files();
    EXPECT_EQ(render(more(12), [] { return true; }), RunState::interrupted);
    auto after = files();
    EXPECT_NE(after["status.json"].find("interrupted"), std::string::npos) << after["status.json"];
    for (const auto& [name, text] : before)
        if (name != "status.json" && name != "log.txt") {
            EXPECT_EQ(after[name], text) << name;
        }
    EXPECT_EQ(after.size(), before.size());

    ASSERT_EQ(render(more(12)), RunState::done);
    EXPECT_NE(files()["job.toml"].find("spp = 12"), std::string::npos) << files()["job.toml"];
    EXPECT_NE(files()["resolved.toml"].find("spp = 12"), std::string::npos);
    EXPECT_EQ(load().state.spp(), 12u);
}

TEST_F(Folders, WithoutCheckpointsTheOldOneStaysUntilTheRenderIsDone) {
    ASSERT_EQ(render(request(3)), RunState::done);
    bool stop = false;
    RenderObserver observer;
    observer.pass = [&](const PassReport& pass, const CombinedImage&) { stop = pass.spp_done > 10; };
    EXPECT_EQ(render(
                  more(100, 0.0), [&] { return stop; }, observer),
              RunState::interrupted);
    EXPECT_EQ(load().state.spp(), 3u);
    EXPECT_NE(files()["log.txt"].find("that of 3 spp stays until the render is done"), std::string::npos);

    EXPECT_EQ(render(more(12, 0.0)), RunState::done);
    EXPECT_FALSE(fs::exists(folder_ / kCheckpointFolder));
}

/// A signal to mpirun reaches the workers, too: they may have left before it is seen here.
TEST_F(Folders, AnInterruptionThatTheWorkersHeedFirstIsNoFailure) {
    std::atomic<bool> leave{false}, asked{false};
    RenderRequest wanted = request(100'000);
    wanted.workers.local = [&](Channel& own) {
        WorkerSettings settings = worker_here(1, Fingerprint().hash());
        settings.told_to_leave = [&] { return leave.load(); };
        run_worker(own, settings, make_renderer, make_log("worker", {}, TellMessage()));
    };
    RenderObserver observer;
    observer.pass = [&](const PassReport&, const CombinedImage&) { leave = true; };
    observer.message = [&](MessageLevel, const std::string& text) {
        if (text.find("leaves, as it was told") != std::string::npos) asked = true;
    };
    EXPECT_EQ(render(
                  wanted, [&] { return asked.load(); }, observer),
              RunState::interrupted);
    EXPECT_NE(files()["summary.json"].find("\"interrupted\""), std::string::npos) << files()["summary.json"];
    EXPECT_NE(files()["log.txt"].find("go on with: treefarm resume"), std::string::npos) << files()["log.txt"];
}

/// A shot of three frames, whose index cannot be written from the second frame on.
class ShotIndex : public Folders {
  protected:
    std::ostringstream told_;

    RunState render_shot(bool room_again) {
        Shot shot;
        shot.directory = folder_;
        shot.frames = {1, 2, 3};
        shot.read_request = [&](int frame) {
            if (frame == 2) {
                fs::remove(folder_ / "shot.json");
                fs::create_directory(folder_ / "shot.json");
            }
            if (frame == 3 && room_again) fs::remove(folder_ / "shot.json");
            return request(2);
        };
        const auto log =
            std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(told_));
        LocalFarm farm(kWorker);
        SeriesContext context;
        context.workers.channel = &farm.channel();
        context.console = std::make_shared<Console>(TerminalKind{}, false);
        context.log = log;
        return run_shot(shot, context).state;
    }

    std::size_t count(const std::string& what) const {
        std::size_t found = 0;
        for (std::size_t at = 0; (at = told_.str().find(what, at)) != std::string::npos; ++at)
            ++found;
        return found;
    }
};

TEST_F(ShotIndex, ThatCannotBeWrittenForAWhileStopsNoFrame) {
    EXPECT_EQ(render_shot(true), RunState::done) << told_.str();
    EXPECT_EQ(count("shot.json: cannot write"), 1u) << told_.str();
    EXPECT_EQ(count("the shot goes on"), 1u) << told_.str();
    std::ifstream file(folder_ / "shot.json");
    const nlohmann::json index = nlohmann::json::parse(file);
    for (const nlohmann::json& frame : index["frames"])
        EXPECT_EQ(frame["state"], "done") << frame;
}

TEST_F(ShotIndex, ThatCannotBeWrittenAtTheEndIsAFailureThatKeepsTheFrames) {
    EXPECT_EQ(render_shot(false), RunState::failed);
    EXPECT_EQ(count("the shot goes on"), 1u) << told_.str();
    EXPECT_EQ(count("the frames that are done are kept"), 1u) << told_.str();
    for (const char* frame : {"frame.0001", "frame.0002", "frame.0003"})
        EXPECT_TRUE(fs::exists(folder_ / frame / "image.exr")) << frame;
}

}  // namespace
}  // namespace treefarm
