// SPDX-License-Identifier: Apache-2.0
// Whatever is left of a checkpoint, the same command ends with the bits of a render that was never disturbed.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

#include "coordinator/render/resume.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"
#include "worker/local_worker.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

/// What can happen to a file.
struct Damage {
    const char* name;
    void (*act)(const fs::path&);
};

void put_text(const fs::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

const std::array<Damage, 8> kDamages = {{
    {"flipped",
     [](const fs::path& file) {
         std::string bytes = test::read_file(file);
         bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 16);
         put_text(file, bytes);
     }},
    {"emptied", [](const fs::path& file) { fs::resize_file(file, 0); }},
    {"cut", [](const fs::path& file) { fs::resize_file(file, fs::file_size(file) - 1); }},
    {"longer", [](const fs::path& file) { std::ofstream(file, std::ios::app) << 'x'; }},
    {"removed", [](const fs::path& file) { fs::remove(file); }},
    {"a folder",
     [](const fs::path& file) {
         fs::remove(file);
         fs::create_directories(file / "inside");
     }},
    {"a pipe",
     [](const fs::path& file) {
         fs::remove(file);
         ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
     }},
    {"a link to nothing",
     [](const fs::path& file) {
         fs::remove(file);
         fs::create_symlink("nowhere", file);
     }},
}};

class DamagedCheckpoint : public ::testing::Test {
  protected:
    fs::path folder_ = test::fresh_test_folder();

    fs::path run(const std::string& name) const { return folder_ / name; }

    RenderRequest request(const fs::path& run, std::uint32_t spp = 15) const {
        RenderRequest request = read_request({.file = test::own_scene("glossy-room.xml"),
                                              .settings = {{"scene.defines.width", "12", {}},
                                                           {"scene.defines.height", "8", {}},
                                                           {"guiding.spatial_threshold", "100", {}},
                                                           {"farm.checkpoint_seconds", "0.001", {}},
                                                           {"output.directory", run.string(), {}}},
                                              .budget = {.spp = spp}});
        return runnable(std::move(request));
    }

    static RenderRequest runnable(RenderRequest request) {
        request.workers.local = [](Channel& own) {
            run_local_worker(own, 1, Fingerprint().hash(), make_log("worker", {}, TellMessage()));
        };
        return request;
    }

    /// The render of the same command, up to the first pass that ends at so many samples or more.
    static RenderOutcome same_command(RenderRequest request, std::uint32_t until = 1000) {
        if (auto there = go_on_in_folder(request)) return std::move(*there);
        bool stop = false;
        request.workers.stop = [&] { return stop; };
        RenderObserver observer;
        observer.pass = [&](const PassReport& pass, const CombinedImage&) { stop = pass.spp_done >= until; };
        return render(request, observer);
    }

    /// A render of 7 of 15 samples, with two checkpoints, the newer of 7 and the older of 3; and the undisturbed one.
    void SetUp() override {
        whole_ = same_command(request(run("whole")));
        ASSERT_EQ(whole_.state, RunState::done);
        EXPECT_EQ(same_command(request(run("broken-off")), 3).state, RunState::interrupted);
        EXPECT_EQ(same_command(request(run("broken-off")), 7).state, RunState::interrupted);
        for (const auto& entry : fs::directory_iterator(run("broken-off") / kCheckpointFolder))
            files_.push_back(entry.path().filename());
        std::sort(files_.begin(), files_.end());
        ASSERT_EQ(files_.size(), 5u) << "two generations and three films";
    }

    /// A copy of the render of 7 samples.
    fs::path copy() const {
        fs::remove_all(run("run"));
        fs::copy(run("broken-off"), run("run"), fs::copy_options::recursive);
        return run("run");
    }

    void expect_whole(const RenderOutcome& outcome, const std::string& what) const {
        EXPECT_EQ(outcome.state, RunState::done) << what;
        EXPECT_EQ(outcome.result.image_hash, whole_.result.image_hash) << what;
        EXPECT_EQ(outcome.result.tree_hash, whole_.result.tree_hash) << what;
        EXPECT_EQ(outcome.result.passes.size(), whole_.result.passes.size()) << what;
        const LoadedCheckpoint left = load_checkpoint(outcome.folder, [](const CheckpointOrigin&) {});
        EXPECT_EQ(left.state.spp(), 15u) << what;
        EXPECT_TRUE(left.warnings.empty()) << what << ": " << left.warnings[0];
    }

    RenderOutcome whole_;
    std::vector<fs::path> files_;
};

TEST_F(DamagedCheckpoint, OfEachFileInEachWayEndsWithTheSameBits) {
    for (const fs::path& file : files_)
        for (const Damage& damage : kDamages) {
            damage.act(copy() / kCheckpointFolder / file);
            expect_whole(same_command(request(run("run"))), file.string() + " is " + damage.name);
        }
}

TEST_F(DamagedCheckpoint, OfBothGenerationsOrAllFilmsEndsWithTheSameBits) {
    for (const std::string kind : {".tfc", ".tff"})
        for (const Damage& damage : kDamages) {
            copy();
            for (const fs::path& file : files_)
                if (file.extension() == kind) damage.act(run("run") / kCheckpointFolder / file);
            expect_whole(same_command(request(run("run"))), kind + " are " + damage.name);
        }
}

/// As a kill during the writing of the first checkpoint leaves it.
TEST_F(DamagedCheckpoint, ThatWasNeverFinishedIsBegunAgain) {
    for (const bool has_films : {true, false}) {
        copy();
        for (const fs::path& file : files_)
            if (!has_films || file.extension() == ".tfc") fs::remove(run("run") / kCheckpointFolder / file);
        RenderRequest again = request(run("run"));
        EXPECT_FALSE(go_on_in_folder(again).has_value());
        EXPECT_TRUE(again.content.warnings.empty()) << "nothing was lost";
        expect_whole(render(again), has_films ? "films alone" : "an empty folder");
        EXPECT_NE(test::refusal_of([&] {
                      copy();
                      fs::remove(run("run") / kCheckpointFolder / "a.tfc");
                      fs::remove(run("run") / kCheckpointFolder / "b.tfc");
                      read_resumed(run("run"), {}, {});
                  }).find("holds no checkpoint"),
                  std::string::npos);
    }
}

TEST_F(DamagedCheckpoint, TakesTheOtherFilmsAndTellsWhatIsTracedAgain) {
    // The film that both generations name first is that of the first pass.
    const LoadedCheckpoint left = load_checkpoint(run("broken-off"), [](const CheckpointOrigin&) {});
    fs::remove(copy() / kCheckpointFolder / left.state.films[0].stored);
    RenderRequest resumed = runnable(read_resumed(run("run"), {}, {}));
    ASSERT_EQ(resumed.content.warnings.size(), 1u);
    EXPECT_NE(resumed.content.warnings[0].find(left.state.films[0].stored + " is missing; its passes are traced again"),
              std::string::npos)
        << resumed.content.warnings[0];
    ASSERT_NE(resumed.start.checkpoint, nullptr);
    std::vector<std::uint32_t> begun;
    RenderObserver observer;
    observer.progress = [&](const RenderProgress& now, const Roster&) {
        if (begun.empty() || begun.back() != now.pass) begun.push_back(now.pass);
    };
    expect_whole(render(resumed, observer), "a first film");
    EXPECT_EQ(begun, (std::vector<std::uint32_t>{0, 3})) << "the lost pass, then those that were left";
}

TEST_F(DamagedCheckpoint, OfARenderThatIsDoneStillTakesMoreSamples) {
    const RenderOutcome more = same_command(request(run("whole"), 40));
    const fs::path again = run("again");
    ASSERT_EQ(same_command(request(again)).state, RunState::done);
    const LoadedCheckpoint left = load_checkpoint(again, [](const CheckpointOrigin&) {});
    for (const PassResult& film : left.state.films)
        fs::resize_file(again / kCheckpointFolder / film.stored, 10);
    const RenderOutcome resumed = same_command(request(again, 40));
    EXPECT_EQ(resumed.result.spp, 40u);
    EXPECT_EQ(resumed.result.image_hash, more.result.image_hash);
    EXPECT_EQ(resumed.result.tree_hash, more.result.tree_hash);
    fs::resize_file(again / kCheckpointFolder / "a.tfc", 10);
    fs::resize_file(again / kCheckpointFolder / "b.tfc", 10);
    EXPECT_NE(test::refusal_of([&] { same_command(request(again, 80)); }).find("no usable checkpoint"),
              std::string::npos)
        << "a result is not replaced unasked";
}

}  // namespace
}  // namespace treefarm
