// SPDX-License-Identifier: Apache-2.0
// Whose a folder is, and what becomes of what it holds.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>

#include "common/image/exr.h"
#include "tests/mpi/program.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm::test {
namespace {

TEST(RunFolder, ARenderIsNotReplacedInSilence) {
    const auto folder = fresh_folder("run");
    ASSERT_EQ(Program(small_render(folder, "7")).wait(kSoon).code, 0);
    const std::string image = read_file(folder / "image.exr");
    const Ending refused = Program(small_render(folder, "3")).wait(kSoon);
    EXPECT_EQ(refused.code, 2) << refused.output;
    EXPECT_NE(refused.output.find("holds a render (done, 7 spp)"), std::string::npos) << refused.output;
    EXPECT_NE(refused.output.find("--overwrite"), std::string::npos) << refused.output;
    EXPECT_EQ(read_file(folder / "image.exr"), image);

    Program broken(small_render(folder, kForever, {"--overwrite", "--set", "guiding.spp_unit=65536"}));
    ASSERT_TRUE(broken.wait_until([&] { return fs::exists(folder / "previous" / "image.exr"); }, kSoon));
    broken.signal(SIGINT);
    const Ending ending = broken.wait(kSoon);
    EXPECT_EQ(ending.code, 3) << ending.output;
    EXPECT_NE(ending.output.find("previous"), std::string::npos) << "says where the earlier run is";
    EXPECT_EQ(read_file(folder / "previous" / "image.exr"), image);
    EXPECT_FALSE(fs::exists(folder / "image.exr")) << "no image of another run beside this one's log";

    ASSERT_EQ(Program(small_render(folder, "3", {"--overwrite"})).wait(kSoon).code, 0);
    EXPECT_EQ(spp_of(folder / "image.exr"), "3");
    for (const char* name : {"previous", "previous-2"})
        EXPECT_FALSE(fs::exists(folder / name)) << name;
}

TEST(RunFolder, IsOneRendersAtATime) {
    const auto folder = fresh_folder("run");
    Program first(small_render(folder, kForever));
    ASSERT_TRUE(first.wait_until([&] { return passes_done(folder) >= 1; }, kSoon));
    const std::string job = read_file(folder / "job.toml");
    const Ending second = Program(small_render(folder, "7", {"--overwrite", "--set", "sampler.seed=2"})).wait(kSoon);
    EXPECT_EQ(second.code, 2) << second.output;
    EXPECT_NE(second.output.find("at work in this folder (process " + std::to_string(first.pid())), std::string::npos)
        << second.output;
    EXPECT_EQ(read_file(folder / "job.toml"), job);
    first.signal(SIGINT);
    EXPECT_EQ(first.wait(kSoon).code, 3);
}

TEST(RunFolder, ItsJobRepeatsTheRunElsewhere) {
    const auto parent = fresh_folder("place"), folder = parent / "run";
    fs::copy_file(own_scene("cornell-box.xml"), parent / "box.xml");
    const std::string here = "cd " + parent.string() + " && " + TREEFARM_PROGRAM + " render ";
    const Ending first =
        Program(Words{"sh", "-c", here + "box.xml -D size=32 --seconds 0.5 -o out.exr --run-dir run"}).wait(kSoon);
    ASSERT_EQ(first.code, 0) << first.output;
    const std::string image = read_file(folder / "image.exr");
    const Ending again = Program(Words{"sh", "-c", here + "run/job.toml --schedule run/schedule.toml"}).wait(kSoon);
    ASSERT_EQ(again.code, 0) << again.output;
    EXPECT_EQ(read_file(folder / "image.exr"), image) << "the record is untouched";
    int runs = 0;
    for (const auto& entry : fs::directory_iterator(parent / "runs")) {
        ++runs;
        EXPECT_EQ(read_summary(entry.path())["image_hash"], read_summary(folder)["image_hash"]);
        EXPECT_EQ(entry.path().filename().string().find("box-"), 0u);
    }
    EXPECT_EQ(runs, 1);

    std::ofstream(parent / "job.toml")
        << "[scene]\nfile = \"box.xml\"\n[budget]\nspp = 3\n[image]\nwidth = 16\nheight = 16\n";
    ASSERT_EQ(Program(Words{"sh", "-c", here + "job.toml --run-dir a"}).wait(kSoon).code, 0);
    ASSERT_EQ(Program(Words{"sh", "-c", here + "job.toml --set scene.file=box.xml --run-dir b"}).wait(kSoon).code, 0);
    for (const char* name : {"a", "b"}) {
        const Ending repeated =
            Program(Words{"sh", "-c", here + name + "/job.toml --run-dir again-" + name}).wait(kSoon);
        EXPECT_EQ(repeated.code, 0) << repeated.output;
    }
}

TEST(RunFolder, AStudysFolderIsNotForRenders) {
    const auto parent = fresh_folder("place"), folder = parent / "study";
    const auto write_study = [&](const std::string& name) {
        std::ofstream(parent / name) << "seeds = 1\nwarmup = 0\n[budget]\nspp = 3\n[job]\nimage.width = 16\n"
                                     << "image.height = 16\n[scene.box]\nfile = \"" << own_scene("cornell-box.xml")
                                     << "\"\n[reference]\nbudget.spp = 3\nsampler.seed = 99\n";
        return (parent / name).string();
    };
    const auto study = [&](const std::string& name, const fs::path& directory, const Words& options = {}) {
        return Program(Words{TREEFARM_PROGRAM, "study", write_study(name), "--dir", directory.string()} + options)
            .wait(kSoon);
    };
    ASSERT_EQ(study("one.toml", folder).code, 0);
    for (const Words& options : {Words{}, Words{"--overwrite"}}) {
        const Ending refused = Program(small_render(folder, "3", options)).wait(kSoon);
        EXPECT_EQ(refused.code, 2) << refused.output;
        EXPECT_NE(refused.output.find("holds a study"), std::string::npos) << refused.output;
    }
    const Ending other = study("two.toml", folder);
    EXPECT_EQ(other.code, 2) << other.output;
    EXPECT_NE(other.output.find("holds another study (one.toml); name another folder with --dir"), std::string::npos)
        << other.output;
    EXPECT_EQ(study("one.toml", folder).code, 0) << "the same study goes on";
    EXPECT_EQ(study("two.toml", folder, {"--overwrite"}).code, 0);

    const auto run = parent / "run";
    ASSERT_EQ(Program(small_render(run, "3")).wait(kSoon).code, 0);
    const Ending into_run = study("one.toml", run, {"--overwrite"});
    EXPECT_EQ(into_run.code, 2) << into_run.output;
    EXPECT_NE(into_run.output.find("holds a render (done, 3 spp)"), std::string::npos) << into_run.output;
}

}  // namespace
}  // namespace treefarm::test
