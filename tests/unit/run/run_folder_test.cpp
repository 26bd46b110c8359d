// SPDX-License-Identifier: Apache-2.0
// Whose a run directory is, and what becomes of what it held.
#include "coordinator/run/run_folder.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "coordinator/run/folder_content.h"
#include "tests/support/refusal.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

void write_run(const fs::path& folder, const std::string& image) {
    test::write_file(folder / "status.json", R"({"state": "running", "spp_done": 7, "pid": 12, "host": "node"})");
    test::write_file(folder / "passes.csv", "pass\n");
    test::write_file(folder / "image.exr", image);
}

Job job_in(const fs::path& folder) {
    Job job;
    job.scene.file = "scene.xml";
    job.output.directory = folder.string();
    return job;
}

std::string refusal(const fs::path& folder, bool overwrite) {
    return test::refusal_of(
        [&] { const RunFolder run(job_in(folder), overwrite ? FolderUse::replace : FolderUse::fresh, {}); });
}

TEST(RunFolder, ARenderIsReplacedOnlyWhenAskedFor) {
    const fs::path folder = test::fresh_test_folder();
    write_run(folder, "first");
    EXPECT_EQ(refusal(folder, false), folder.string() +
                                          ": holds a render (broken off, 7 spp); go on with it by treefarm resume, "
                                          "replace it with --overwrite, or name another folder with --run-dir");
    EXPECT_EQ(test::read_file(folder / "image.exr"), "first");
    {
        const RunFolder run(job_in(folder), FolderUse::replace, {});
        EXPECT_FALSE(fs::exists(folder / "image.exr"));
        EXPECT_EQ(test::read_file(folder / "previous" / "image.exr"), "first");
        EXPECT_TRUE(run.has_previous());
    }
    write_run(folder, "second");
    const RunFolder again(job_in(folder), FolderUse::replace, {});
    EXPECT_EQ(test::read_file(folder / "previous" / "image.exr"), "first");
    EXPECT_EQ(test::read_file(folder / "previous-2" / "image.exr"), "second");
    again.remove_previous();
    EXPECT_FALSE(again.has_previous());
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(RunFolder, ARenderThatGoesOnKeepsItsFiles) {
    const fs::path folder = test::fresh_test_folder();
    write_run(folder, "first");
    const RunFolder run(job_in(folder), FolderUse::resume, {});
    EXPECT_EQ(test::read_file(folder / "image.exr"), "first");
    EXPECT_FALSE(run.has_previous());
    run.give_back();
    EXPECT_EQ(test::read_file(folder / "image.exr"), "first");
}

TEST(RunFolder, KeepsWhatIsNotTheRunsOwn) {
    const fs::path folder = test::fresh_test_folder();
    write_run(folder, "first");
    test::write_file(folder / "notes.txt", "mine");
    test::write_file(folder / "previous-notes" / "a.txt", "mine");
    const RunFolder run(job_in(folder), FolderUse::replace, {});
    run.remove_previous();
    EXPECT_EQ(test::read_file(folder / "notes.txt"), "mine");
    EXPECT_EQ(test::read_file(folder / "previous-notes" / "a.txt"), "mine");
}

TEST(RunFolder, AnEarlierRunThatLiesAsideIsNoOtherFile) {
    const fs::path folder = test::fresh_test_folder();
    write_run(folder / "previous", "first");
    EXPECT_EQ(refusal(folder, false), "");
    EXPECT_EQ(test::read_file(folder / "previous" / "image.exr"), "first");
}

TEST(RunFolder, StudiesAndOtherFilesAreNeverReplaced) {
    const fs::path study = test::fresh_test_folder() / "study", cells = test::fresh_test_folder() / "cells",
                   other = test::fresh_test_folder() / "other";
    const fs::path shot = test::fresh_test_folder() / "shot";
    test::write_file(study / "study.json", "{}");
    test::write_file(study / "passes.csv", "of the report");
    test::write_file(cells / "cells" / "a" / "passes.csv", "pass");
    test::write_file(other / "job.toml", "mine");
    test::write_file(shot / "shot.json", "{}");
    for (const bool overwrite : {false, true}) {
        EXPECT_NE(refusal(study, overwrite).find("holds a study"), std::string::npos);
        EXPECT_NE(refusal(cells, overwrite).find("holds a study"), std::string::npos);
        EXPECT_NE(refusal(shot, overwrite).find("holds a shot"), std::string::npos);
        EXPECT_NE(refusal(other, overwrite).find("holds other files"), std::string::npos);
    }
    EXPECT_EQ(test::read_file(other / "job.toml"), "mine");
}

/// A run directory that is removed while it is rendered keeps what the render writes meanwhile.
TEST(RunFolder, FilesOfARenderWithoutItsStatusAreThatRender) {
    for (const char* left :
         {"schedule.toml", "preview.png", "image.exr", "tree.bin", "summary.json", "checkpoint/state"}) {
        const fs::path folder = test::fresh_test_folder();
        test::write_file(folder / left, "half");
        EXPECT_EQ(folder_content(folder), FolderContent::render) << left;
        EXPECT_NE(refusal(folder, false).find("holds a render (broken off, 0 spp)"), std::string::npos) << left;
        EXPECT_EQ(refusal(folder, true), "") << left;
        EXPECT_EQ(test::read_file(folder / "previous" / left), "half");
    }
    const fs::path folder = test::fresh_test_folder();
    test::write_file(folder / "preview.png", "half");
    test::write_file(folder / "mine", "mine");
    EXPECT_EQ(folder_content(folder), FolderContent::other);
}

TEST(RunFolder, FramesThatWereRenderedOneByOneAreAShot) {
    const fs::path folder = test::fresh_test_folder();
    test::write_file(folder / "frame.0007.exr", "image");
    test::write_file(folder / "frame.x" / "passes.csv", "pass");
    EXPECT_EQ(folder_content(folder), FolderContent::other);
    write_run(folder / "frame.0007", "seventh");
    EXPECT_EQ(folder_content(folder), FolderContent::shot);
    EXPECT_NE(refusal(folder, true).find("holds a shot"), std::string::npos);
}

TEST(RunFolder, IsOneProgramsAlsoAfterItWasRemoved) {
    const fs::path folder = test::fresh_test_folder();
    const RunFolder run(job_in(folder), FolderUse::fresh, {});
    fs::remove_all(folder);
    run.renew();
    EXPECT_TRUE(fs::is_directory(folder));
    EXPECT_NE(refusal(folder, true).find("another render or study is at work"), std::string::npos);
}

TEST(RunFolder, IsTheOtherProgramsOnceItWasRemoved) {
    const fs::path folder = test::fresh_test_folder();
    const RunFolder run(job_in(folder), FolderUse::fresh, {});
    fs::rename(folder, folder.string() + "-renamed");
    {
        const RunFolder other(job_in(folder), FolderUse::fresh, {});
        EXPECT_THROW(run.renew(), FileError);
    }
    fs::remove_all(folder.string() + "-renamed");
    run.renew();
    EXPECT_NE(refusal(folder, true).find("another render or study is at work"), std::string::npos);
}

TEST(RunFolder, IsOnePrograms) {
    const fs::path folder = test::fresh_test_folder();
    const RunFolder run(job_in(folder), FolderUse::fresh, {});
    test::write_file(folder / "status.json", R"({"state": "running", "pid": 12, "host": "node"})");
    const std::string refused = refusal(folder, true);
    EXPECT_NE(refused.find(folder.string() + ": another render or study is at work"), std::string::npos) << refused;
    EXPECT_NE(refused.find("process 12 on node"), std::string::npos) << refused;
}

TEST(RunFolder, RemovesWhatAKilledRunWasWriting) {
    const fs::path folder = test::fresh_test_folder();
    test::write_file(folder / "image.exr.tmp-abcdefghij01", "half");
    EXPECT_EQ(refusal(folder, false), "");
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(RunFolder, AutomaticNamesDiffer) {
    const fs::path before = fs::current_path();
    fs::current_path(test::fresh_test_folder());
    Job job = job_in("");
    const RunFolder a(job, FolderUse::fresh, {}), b(job, FolderUse::fresh, {}), c(job, FolderUse::fresh, {});
    EXPECT_NE(a.path(), b.path());
    EXPECT_NE(b.path(), c.path());
    fs::current_path(before);
}

}  // namespace
}  // namespace treefarm
