// SPDX-License-Identifier: Apache-2.0
// Links, pipes and folders in the place of a run's files, as another user of the folder could put them there.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "common/runs/run_files.h"
#include "coordinator/render/finished_render.h"
#include "coordinator/render/resume.h"
#include "coordinator/run/folder_content.h"
#include "report/run_results.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"
#include "worker/local_worker.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

/// Names of all files that a render without farm.join writes.
std::vector<std::string> names() {
    std::vector<std::string> names;
    for (const RunFile& file : kRunFiles)
        if (file.name != std::string(kTicketFileName)) names.emplace_back(file.name);
    return names;
}

class SpecialFiles : public ::testing::Test {
  protected:
    fs::path folder_ = test::fresh_test_folder(), run_ = folder_ / "run";

    void SetUp() override { ::alarm(300); }  // a test that hangs must end
    void TearDown() override { ::alarm(0); }

    RenderRequest request(std::uint32_t spp = 7) const {
        RenderRequest request = read_request({.file = test::own_scene("glossy-room.xml"),
                                              .settings = {{"scene.defines.width", "12", {}},
                                                           {"scene.defines.height", "8", {}},
                                                           {"farm.checkpoint_seconds", "0.001", {}},
                                                           {"output.directory", run_.string(), {}}},
                                              .budget = {.spp = spp}});
        request.workers.local = [](Channel& own) {
            run_local_worker(own, 1, Fingerprint().hash(), make_log("worker", {}, TellMessage()));
        };
        return request;
    }
};

TEST_F(SpecialFiles, ALinkInThePlaceOfAFileIsReplacedAndNotFollowed) {
    RenderObserver observer;
    observer.pass = [&](const PassReport& pass, const CombinedImage&) {
        if (pass.plan.index != 1) return;
        for (const std::string& name : names()) {
            test::write_file(folder_ / ("other-" + name), "somebody's");
            fs::create_symlink(folder_ / ("other-" + name), folder_ / "link");
            fs::rename(folder_ / "link", run_ / name);  // at once, since the render writes meanwhile
        }
    };
    const RenderOutcome outcome = render(request(), observer);
    EXPECT_EQ(outcome.state, RunState::done) << outcome.error;
    for (const std::string& name : names())
        EXPECT_EQ(test::read_file(folder_ / ("other-" + name)), "somebody's") << name;
    for (const char* name : {kStatusFile, kSummaryFile, kImageFile, kPreviewFile, kPassesFile, kScheduleFile, kLogFile})
        EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(run_ / name))) << name;
}

/// The file that -o names is the user's own: a link there is meant.
TEST_F(SpecialFiles, ALinkThatTheUserNamesIsFollowed) {
    RenderRequest wanted = request();
    test::write_file(folder_ / "target.png", "old");
    fs::create_symlink(folder_ / "target.png", folder_ / "link.png");
    wanted.content.job.output.file = (folder_ / "link.png").string();
    EXPECT_EQ(render(wanted).state, RunState::done);
    EXPECT_TRUE(fs::is_symlink(folder_ / "link.png"));
    EXPECT_GT(fs::file_size(folder_ / "target.png"), 3u);
}

TEST_F(SpecialFiles, APipeOrAFolderInThePlaceOfAFileHangsNothing) {
    ASSERT_EQ(render(request(3)).state, RunState::done);
    fs::rename(run_, folder_ / "done");
    for (const bool pipe : {true, false})
        for (const std::string& name : names()) {
            fs::remove_all(run_);
            fs::copy(folder_ / "done", run_, fs::copy_options::recursive);
            fs::remove(run_ / name);
            if (pipe)
                ASSERT_EQ(::mkfifo((run_ / name).c_str(), 0600), 0);
            else
                fs::create_directory(run_ / name);
            SCOPED_TRACE(name + (pipe ? " is a pipe" : " is a folder"));
            folder_content(run_);
            render_words(run_);
            read_figures(run_);
            try {
                read_run_results({&run_, 1});
            } catch (const InputError&) {
            }
            try {
                RenderRequest again = request(7);
                if (go_on_in_folder(again)) continue;
                // The end of a render tries for seconds to write its results: one of those is enough.
                if (name == kLogFile || name == kStatusFile || (pipe && name == kImageFile)) {
                    const RenderOutcome outcome = render(again);
                    if (outcome.state != RunState::done) {
                        EXPECT_NE(outcome.error.find(run_.string()), std::string::npos) << outcome.error;
                    }
                }
            } catch (const InputError& error) {
                EXPECT_NE(std::string(error.what()).find(run_.string()), std::string::npos) << error.what();
            }
        }
}

}  // namespace
}  // namespace treefarm
