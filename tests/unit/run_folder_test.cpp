// SPDX-License-Identifier: Apache-2.0
// Whose a run directory is, and what becomes of what it held.
#include "coordinator/run/run_folder.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/base/error.h"
#include "coordinator/run/folder_content.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

fs::path fresh_folder() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    const fs::path folder = fs::path(testing::TempDir()) / (std::string("folder_") + test->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
}

void write(const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
}

void write_run(const fs::path& folder, const std::string& image) {
    write(folder / "status.json", R"({"state": "running", "spp_done": 7, "pid": 12, "host": "node"})");
    write(folder / "passes.csv", "pass\n");
    write(folder / "image.exr", image);
}

std::string read(const fs::path& path) {
    std::string text;
    std::ifstream(path) >> text;
    return text;
}

Job job_in(const fs::path& folder) {
    Job job;
    job.scene.file = "scene.xml";
    job.output.directory = folder.string();
    return job;
}

std::string refusal(const fs::path& folder, bool overwrite) {
    try {
        const RunFolder run(job_in(folder), overwrite ? FolderUse::replace : FolderUse::fresh, {});
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

TEST(RunFolder, ARenderIsReplacedOnlyWhenAskedFor) {
    const fs::path folder = fresh_folder();
    write_run(folder, "first");
    EXPECT_EQ(refusal(folder, false), folder.string() +
                                          ": holds a render (broken off, 7 spp); go on with it by treefarm resume, "
                                          "replace it with --overwrite, or name another folder with --run-dir");
    EXPECT_EQ(read(folder / "image.exr"), "first");
    {
        const RunFolder run(job_in(folder), FolderUse::replace, {});
        EXPECT_FALSE(fs::exists(folder / "image.exr"));
        EXPECT_EQ(read(folder / "previous" / "image.exr"), "first");
        EXPECT_TRUE(run.has_previous());
    }
    write_run(folder, "second");
    const RunFolder again(job_in(folder), FolderUse::replace, {});
    EXPECT_EQ(read(folder / "previous" / "image.exr"), "first");
    EXPECT_EQ(read(folder / "previous-2" / "image.exr"), "second");
    again.remove_previous();
    EXPECT_FALSE(again.has_previous());
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(RunFolder, ARenderThatGoesOnKeepsItsFiles) {
    const fs::path folder = fresh_folder();
    write_run(folder, "first");
    const RunFolder run(job_in(folder), FolderUse::resume, {});
    EXPECT_EQ(read(folder / "image.exr"), "first");
    EXPECT_FALSE(run.has_previous());
    run.give_back();
    EXPECT_EQ(read(folder / "image.exr"), "first");
}

TEST(RunFolder, KeepsWhatIsNotTheRunsOwn) {
    const fs::path folder = fresh_folder();
    write_run(folder, "first");
    write(folder / "notes.txt", "mine");
    write(folder / "previous-notes" / "a.txt", "mine");
    const RunFolder run(job_in(folder), FolderUse::replace, {});
    run.remove_previous();
    EXPECT_EQ(read(folder / "notes.txt"), "mine");
    EXPECT_EQ(read(folder / "previous-notes" / "a.txt"), "mine");
}

TEST(RunFolder, AnEarlierRunThatLiesAsideIsNoOtherFile) {
    const fs::path folder = fresh_folder();
    write_run(folder / "previous", "first");
    EXPECT_EQ(refusal(folder, false), "");
    EXPECT_EQ(read(folder / "previous" / "image.exr"), "first");
}

TEST(RunFolder, StudiesAndOtherFilesAreNeverReplaced) {
    const fs::path study = fresh_folder() / "study", cells = fresh_folder() / "cells", other = fresh_folder() / "other";
    const fs::path shot = fresh_folder() / "shot";
    write(study / "study.json", "{}");
    write(study / "passes.csv", "of the report");
    write(cells / "cells" / "a" / "passes.csv", "pass");
    write(other / "job.toml", "mine");
    write(shot / "shot.json", "{}");
    for (const bool overwrite : {false, true}) {
        EXPECT_NE(refusal(study, overwrite).find("holds a study"), std::string::npos);
        EXPECT_NE(refusal(cells, overwrite).find("holds a study"), std::string::npos);
        EXPECT_NE(refusal(shot, overwrite).find("holds a shot"), std::string::npos);
        EXPECT_NE(refusal(other, overwrite).find("holds other files"), std::string::npos);
    }
    EXPECT_EQ(read(other / "job.toml"), "mine");
}

TEST(RunFolder, FramesThatWereRenderedOneByOneAreAShot) {
    const fs::path folder = fresh_folder();
    write(folder / "frame.0007.exr", "image");
    write(folder / "frame.x" / "passes.csv", "pass");
    EXPECT_EQ(folder_content(folder), FolderContent::other);
    write_run(folder / "frame.0007", "seventh");
    EXPECT_EQ(folder_content(folder), FolderContent::shot);
    EXPECT_NE(refusal(folder, true).find("holds a shot"), std::string::npos);
}

TEST(RunFolder, IsOnePrograms) {
    const fs::path folder = fresh_folder();
    const RunFolder run(job_in(folder), FolderUse::fresh, {});
    write(folder / "status.json", R"({"state": "running", "pid": 12, "host": "node"})");
    const std::string refused = refusal(folder, true);
    EXPECT_NE(refused.find(folder.string() + ": another render or study is at work"), std::string::npos) << refused;
    EXPECT_NE(refused.find("process 12 on node"), std::string::npos) << refused;
}

TEST(RunFolder, RemovesWhatAKilledRunWasWriting) {
    const fs::path folder = fresh_folder();
    write(folder / "image.exr.tmp-abcdefghij01", "half");
    EXPECT_EQ(refusal(folder, false), "");
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST(RunFolder, AutomaticNamesDiffer) {
    const fs::path before = fs::current_path();
    fs::current_path(fresh_folder());
    Job job = job_in("");
    const RunFolder a(job, FolderUse::fresh, {}), b(job, FolderUse::fresh, {}), c(job, FolderUse::fresh, {});
    EXPECT_NE(a.path(), b.path());
    EXPECT_NE(b.path(), c.path());
    fs::current_path(before);
}

}  // namespace
}  // namespace treefarm
