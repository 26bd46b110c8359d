// SPDX-License-Identifier: Apache-2.0
// What a render leaves in its folder, whatever happens to the disk, the folder, or the program.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>

#include <algorithm>
#include <fstream>

#include "common/image/exr.h"
#include "tests/mpi/program.h"
#include "tests/support/read_ldr.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm::test {
namespace {

/// A disk of so many KiB below a fresh folder; not there where mounting is not permitted.
class SmallDisk {
  public:
    explicit SmallDisk(int kilobytes) : path_(fresh_folder("disk")) {
        mounted_ = ::mount("treefarm-test", path_.c_str(), "tmpfs", 0,
                           ("size=" + std::to_string(kilobytes) + "k").c_str()) == 0;
    }
    ~SmallDisk() {
        if (mounted_) ::umount2(path_.c_str(), MNT_DETACH);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

    bool mounted() const { return mounted_; }
    const fs::path& path() const { return path_; }
    void fill() const {
        std::ofstream file(path_ / "filler", std::ios::binary);
        for (const std::string block(4096, 'x'); file;)
            file << block << std::flush;
    }
    void clear() const { fs::remove(path_ / "filler"); }

  private:
    const fs::path path_;
    bool mounted_ = false;
};

constexpr char kNoDisk[] = "mounting a small tmpfs is not permitted here";

TEST(RunDirectory, ADiskThatFillsForAWhileChangesNothing) {
    const SmallDisk disk(4096);
    if (!disk.mounted()) GTEST_SKIP() << kNoDisk;
    const auto calm = fresh_folder("calm");
    ASSERT_EQ(Program(small_render(calm, "508")).wait(kSoon).code, 0);

    const fs::path folder = disk.path() / "run";
    Program program(small_render(folder, "508"));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 1; }, kSoon));
    disk.fill();
    program.wait_until([] { return false; }, 2.5);
    disk.clear();
    const Ending ending = program.wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_EQ(read_summary(folder)["state"], "done");
    EXPECT_EQ(read_summary(folder)["image_hash"], read_summary(calm)["image_hash"]);
    EXPECT_EQ(spp_of(folder / "image.exr"), spp_of(calm / "image.exr"));
    EXPECT_EQ(passes_done(folder), passes_done(calm));
}

TEST(RunDirectory, ADiskThatStaysFullKeepsWhatFits) {
    const SmallDisk disk(4096);
    if (!disk.mounted()) GTEST_SKIP() << kNoDisk;
    const fs::path folder = disk.path() / "run", elsewhere = fresh_folder("elsewhere") / "box.exr";
    Program program(small_render(folder, kForever, {"-o", elsewhere.string()}));
    ASSERT_TRUE(program.wait_until([&] { return fs::exists(folder / "image.exr"); }, kSoon));
    disk.fill();
    const std::string kept = spp_of(folder / "image.exr");
    ASSERT_NE(kept, "none");
    ASSERT_TRUE(
        program.wait_until([&] { return read_file(program.output()).find("goes on") != std::string::npos; }, kSoon))
        << "the trouble is told";
    program.signal(SIGINT);
    const Ending ending = program.wait(kSoon);
    EXPECT_EQ(ending.code, 1) << ending.output;
    EXPECT_NE(ending.output.find(": cannot write"), std::string::npos) << ending.output;
    EXPECT_EQ(spp_of(folder / "image.exr"), kept) << "the last that fitted is whole";
    EXPECT_GE(std::stoi(spp_of(elsewhere)), std::stoi(kept));
    std::size_t reports = 0;
    for (std::size_t at = 0; (at = ending.output.find("the render goes on", at)) != std::string::npos; ++at)
        ++reports;
    EXPECT_EQ(reports, 1u) << ending.output;
}

TEST(RunDirectory, AnOutputFileThatCannotBeWrittenCostsOnlyItself) {
    const SmallDisk disk(64);
    if (!disk.mounted()) GTEST_SKIP() << kNoDisk;
    const auto folder = fresh_folder("run");
    const Ending ending = Program(small_render(folder, "7", {"-o", (disk.path() / "box.exr").string()})).wait(kSoon);
    EXPECT_EQ(ending.code, 1) << ending.output;
    const nlohmann::json summary = read_summary(folder);
    EXPECT_EQ(summary["state"], "failed");
    EXPECT_NE(summary["error"].get<std::string>().find("box.exr: cannot write"), std::string::npos) << summary["error"];
    EXPECT_EQ(read_json(folder / "status.json")["state"], "failed");
    EXPECT_EQ(spp_of(folder / "image.exr"), "7");
}

TEST(RunDirectory, AFolderThatVanishesIsMadeAgain) {
    const auto folder = fresh_folder("run");
    Program program(small_render(folder, kForever));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 2; }, kSoon));
    const fs::path gone = folder.string() + "-gone";  // in one step: its writers are at work
    fs::rename(folder, gone);
    fs::remove_all(gone);
    ASSERT_TRUE(program.wait_until([&] { return fs::exists(folder / "status.json"); }, kSoon));
    program.signal(SIGINT);
    EXPECT_EQ(program.wait(kSoon).code, 3);
    for (const char* name : {"job.toml", "plan.txt", "passes.csv", "schedule.toml", "image.exr", "preview.png",
                             "summary.json", "status.json", "log.txt"})
        EXPECT_TRUE(fs::exists(folder / name)) << name;
}

TEST(RunDirectory, AKilledRenderLeavesTheLastImage) {
    const auto folder = fresh_folder("run");
    {
        Program program(small_render(folder, kForever));
        ASSERT_TRUE(
            program.wait_until([&] { return fs::exists(folder / "image.exr") && passes_done(folder) >= 3; }, kSoon));
        program.signal(SIGKILL);
        program.wait(kSoon);
    }
    const ExrImage image = read_exr(folder / "image.exr");
    EXPECT_GE(std::stoi(image.attributes.at("treefarm.spp")), 1);
    EXPECT_EQ(image.attributes.at("treefarm.job").find(folder.string()), std::string::npos);
    const nlohmann::json status = read_json(folder / "status.json");
    EXPECT_EQ(status["state"], "running");
    EXPECT_GT(status["pid"].get<int>(), 0);
    EXPECT_FALSE(status["host"].get<std::string>().empty());
    EXPECT_GT(status["time"].get<std::int64_t>(), 1'600'000'000);
    // The header is that of its pass: the schedule in it gives the same pixels.
    std::ofstream(folder / "header.toml") << image.attributes.at("treefarm.schedule");
    const auto again = fresh_folder("again");
    ASSERT_EQ(Program(Words{TREEFARM_PROGRAM, "render", (folder / "job.toml").string(), "--run-dir", again.string(),
                            "--schedule", (folder / "header.toml").string()})
                  .wait(kSoon)
                  .code,
              0);
    EXPECT_EQ(read_summary(again)["image_hash"], image.attributes.at("treefarm.image_hash"));
    EXPECT_EQ(read_exr(again / "image.exr").image.data, image.image.data);
}

TEST(RunDirectory, APreviewComesBeforeTheFirstPass) {
    const auto folder = fresh_folder("run");
    Program program(small_render(folder, kForever, {"--set", "guiding.spp_unit=4096", "--set", "farm.tile_size=8"}));
    ASSERT_TRUE(program.wait_until(
        [&] {
            if (!fs::exists(folder / "preview.png")) return false;
            const Image image = read_ldr(folder / "preview.png", Encoding::linear);
            return std::any_of(image.data.begin(), image.data.end(), [](float v) { return v > 0; });
        },
        kSoon))
        << "pixels that have come are shown";
    EXPECT_FALSE(fs::exists(folder / "image.exr"));
    program.signal(SIGINT);
    EXPECT_EQ(program.wait(kSoon).code, 3);
    EXPECT_EQ(read_summary(folder)["spp"], 0);
}

TEST(RunDirectory, AReaderThatClosesEndsNothing) {
    const auto folder = fresh_folder("run");
    std::string command = "(";
    for (const std::string& word : small_render(folder, "7"))
        command += "'" + word + "' ";
    const Ending ending =
        Program(Words{"bash", "-c", command + "; echo $? > '" + folder.string() + "-code') 2>&1 | true"}).wait(kSoon);
    EXPECT_EQ(ending.code, 0);
    EXPECT_EQ(read_file(folder.string() + "-code"), "0\n");
    EXPECT_EQ(read_summary(folder)["state"], "done");
    EXPECT_NE(read_file(folder / "log.txt").find("7 spp in"), std::string::npos) << "the log goes on";
}

TEST(RunDirectory, NohupKeepsARenderAlive) {
    const auto folder = fresh_folder("run");
    Words command = {"nohup"};
    Program program(command + small_render(folder, kForever));
    ASSERT_TRUE(program.wait_until([&] { return passes_done(folder) >= 1; }, kSoon));
    program.signal(SIGHUP);
    const int before = passes_done(folder);
    EXPECT_TRUE(program.wait_until([&] { return passes_done(folder) > before; }, kSoon));
    program.signal(SIGTERM);
    EXPECT_EQ(program.wait(kSoon).code, 3);
}

TEST(RunDirectory, NamesThatAreNoUtf8DoNoHarm) {
    const auto parent = fresh_folder("place");
    const std::string odd = "caf\xe9\n\x1b[31mred";
    fs::copy_file(own_scene("cornell-box.xml"), parent / (odd + ".xml"));
    const auto folder = parent / (odd + "-run");
    const Ending ending = Program(Words{TREEFARM_PROGRAM, "render", (parent / (odd + ".xml")).string(), "-D", "size=16",
                                        "--spp", "3", "--run-dir", folder.string()})
                              .wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_EQ(read_summary(folder)["state"], "done");
    EXPECT_EQ(read_json(folder / "status.json")["state"], "done");
    EXPECT_FALSE(read_json(folder / "plan.json").is_discarded());
    EXPECT_EQ(read_file(folder / "log.txt").find('\x1b'), std::string::npos);
    EXPECT_EQ(ending.output.find('\x1b'), std::string::npos) << ending.output;
}

}  // namespace
}  // namespace treefarm::test
