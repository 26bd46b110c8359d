// SPDX-License-Identifier: Apache-2.0
// A study that is killed goes on where it was, and reports the same numbers.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/file.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <map>

#include "common/image/exr.h"
#include "tests/mpi/program.h"
#include "tests/support/support.h"

namespace treefarm::test {
namespace {

constexpr std::size_t kCells = 3 * 2 * 4;

fs::path write_study(const fs::path& folder) {
    const fs::path file = folder / "small.toml";
    std::ofstream(file) << "seeds = 4\n[budget]\nspp = 6\n[job]\nimage.width = 20\nimage.height = 16\n"
                        << "farm.heartbeat_seconds = 0.2\n"
                        << "[scene.box]\nfile = \"" << own_scene("cornell-box.xml") << "\"\n"
                        << "[scene.caustic]\nfile = \"" << own_scene("caustic.xml") << "\"\n"
                        << "[method.unguided]\nguiding.type = \"none\"\n[method.paper]\nguiding.preset = \"paper\"\n"
                        << "[method.own]\nguiding.spatial_threshold = 200\n"
                        << "[reference]\nguiding.type = \"none\"\nbudget.spp = 32\nsampler.seed = 99\n";
    return file;
}

std::vector<std::string> study(const fs::path& file, const fs::path& directory) {
    return {TREEFARM_PROGRAM, "study", file.string(), "--dir", directory.string(), "--threads", "1"};
}

/// cell.json of every cell that is whole, by its folder.
std::map<std::string, nlohmann::json> whole_cells(const fs::path& directory) {
    std::map<std::string, nlohmann::json> cells;
    if (!fs::exists(directory / "cells")) return cells;
    for (const auto& entry : fs::directory_iterator(directory / "cells"))
        if (fs::exists(entry.path() / "cell.json"))
            cells[entry.path().filename()] = read_json(entry.path() / "cell.json");
    return cells;
}

void expect_same_numbers(const std::map<std::string, nlohmann::json>& a,
                         const std::map<std::string, nlohmann::json>& b) {
    ASSERT_EQ(a.size(), kCells);
    ASSERT_EQ(b.size(), kCells);
    for (const auto& [name, cell] : a) {
        ASSERT_TRUE(b.contains(name)) << name;
        const nlohmann::json& other = b.at(name);
        EXPECT_EQ(cell["flip"], other["flip"]) << name;
        ASSERT_EQ(cell["passes"].size(), other["passes"].size()) << name;
        for (std::size_t k = 0; k < cell["passes"].size(); ++k)
            for (const char* figure : {"measured", "spp_done", "stuv", "nonzero_share", "tree_memory", "image_error"})
                EXPECT_EQ(cell["passes"][k][figure], other["passes"][k][figure]) << name << ", " << figure;
    }
}

class StudyTest : public ::testing::TestWithParam<int> {};

TEST_P(StudyTest, KilledHalfWayGoesOn) {
    const auto launcher = GetParam() == 0 ? std::vector<std::string>() : mpirun(GetParam());
    const fs::path folder = fresh_folder("study"), broken = folder / "broken", whole = folder / "whole";
    const fs::path file = write_study(folder);
    {
        Program program(launcher + study(file, broken));
        ASSERT_TRUE(program.wait_until([&] { return whole_cells(broken).size() >= kCells / 2; }, kSoon));
        program.signal(SIGKILL);
        program.wait(10);
    }
    const auto before = whole_cells(broken);
    ASSERT_LT(before.size(), kCells) << "the kill came too late to test anything";

    const Ending again = Program(launcher + study(file, broken)).wait(kSoon);
    EXPECT_EQ(again.code, 0) << again.output;
    const auto after = whole_cells(broken);
    for (const auto& [name, cell] : before)
        EXPECT_EQ(after.at(name), cell) << "a finished cell was rendered again: its seconds would differ";

    const Ending ending = Program(launcher + study(file, whole)).wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    expect_same_numbers(after, whole_cells(whole));
    EXPECT_EQ(read_json(broken / "study.json")["cells"], read_json(whole / "study.json")["cells"]);

    const Ending dry = Program(study(file, whole) + std::vector<std::string>{"--dry-run", "--no-probe"}).wait(kSoon);
    EXPECT_NE(dry.output.find("24 of 24 cells are done"), std::string::npos) << dry.output;

    std::vector<std::string> other_build = study(file, whole) + std::vector<std::string>{"--dry-run", "--no-probe"};
    other_build[0] = folder / "treefarm";
    fs::copy_file(TREEFARM_PROGRAM, other_build[0]);
    std::ofstream(other_build[0], std::ios::binary | std::ios::app) << ' ';
    const Ending other = Program(other_build).wait(kSoon);
    EXPECT_NE(other.output.find("0 of 24 cells are done"), std::string::npos) << other.output;
}

INSTANTIATE_TEST_SUITE_P(Ranks, StudyTest, ::testing::Values(0, 3));

TEST(StudyProgram, AnInterruptIsResumable) {
    const fs::path folder = fresh_folder("study");
    const fs::path file = write_study(folder);
    Program program(study(file, folder / "results"));
    ASSERT_TRUE(program.wait_until([&] { return !whole_cells(folder / "results").empty(); }, kSoon));
    program.signal(SIGINT);
    const Ending ending = program.wait(kSoon);
    EXPECT_EQ(ending.code, 3) << ending.output;
    EXPECT_NE(ending.output.find("goes on from here"), std::string::npos) << ending.output;
}

TEST(StudyProgram, TwoDoNotWorkInOneFolder) {
    const fs::path folder = fresh_folder("study");
    const fs::path file = write_study(folder), results = folder / "results";
    fs::create_directories(results);
    const int fd = ::open(results.c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(::flock(fd, LOCK_EX), 0);
    Program waiting(study(file, results));
    EXPECT_FALSE(waiting.wait_until([&] { return !whole_cells(results).empty(); }, 0.5));
    ::close(fd);
    EXPECT_EQ(waiting.wait(kSoon).code, 0);

    const int again = ::open(results.c_str(), O_RDONLY | O_CLOEXEC);
    ASSERT_EQ(::flock(again, LOCK_EX), 0);
    const Ending ending = Program(study(file, results)).wait(kSoon);
    ::close(again);
    EXPECT_EQ(ending.code, 1) << ending.output;
    EXPECT_NE(ending.output.find("another study is at work"), std::string::npos) << ending.output;
}

/// A study against a given image: one method, one seed, 20 x 16 pixels, 4 spp.
fs::path write_study_with(const std::string& reference, const fs::path& folder) {
    const fs::path file = folder / "given.toml";
    std::ofstream(file) << "seeds = 2\nwarmup = 0\n[budget]\nspp = 7\n[job]\nimage.width = 20\nimage.height = 16\n"
                        << "[scene.box]\nfile = \"" << own_scene("cornell-box.xml") << "\"\n"
                        << "reference = \"" << reference << "\"\n[method.unguided]\nguiding.type = \"none\"\n";
    return file;
}

TEST(StudyProgram, MeasuresAgainstAGivenImage) {
    const fs::path folder = fresh_folder("study");
    const std::vector<std::string> render = {TREEFARM_PROGRAM,
                                             "render",
                                             own_scene("cornell-box.xml"),
                                             "--spp",
                                             "256",
                                             "--set",
                                             "image.width=20",
                                             "--set",
                                             "image.height=16",
                                             "--set",
                                             "guiding.type=none",
                                             "--set",
                                             "sampler.seed=99",
                                             "--quiet",
                                             "--run-dir",
                                             (folder / "run").string(),
                                             "-o",
                                             (folder / "mine.exr").string()};
    ASSERT_EQ(Program(render).wait(kSoon).code, 0);
    for (const int ranks : {0, 2}) {
        const auto launcher = ranks == 0 ? std::vector<std::string>() : mpirun(ranks);
        const fs::path results = folder / ("results" + std::to_string(ranks));
        const Ending ending = Program(launcher + study(write_study_with("mine.exr", folder), results)).wait(kSoon);
        ASSERT_EQ(ending.code, 0) << ending.output;
        const nlohmann::json reference = read_json(results / "study.json")["scenes"][0]["reference"];
        EXPECT_EQ(reference["rendered"], false);
        EXPECT_EQ(fs::path(reference["file"].get<std::string>()), folder / "mine.exr") << "relative to the study file";
        EXPECT_GT(reference["error"].get<double>(), 0) << "one of ours says how far it can be trusted";
        const auto cells = whole_cells(results);
        ASSERT_EQ(cells.size(), 2u);
        for (const auto& [name, cell] : cells) {
            // 7 against 256 samples: the error is that of the cell, which knows it.
            const nlohmann::json& last = cell["passes"].back();
            EXPECT_NEAR(std::log(last["measured"]["rmse_over_mean"].get<double>() /
                                 last["image_error"]["relative"].get<double>()),
                        0.0, 0.7)
                << name;
            const nlohmann::json summary = read_summary(results / "cells" / name);
            for (const char* where : {"host", "started"})
                EXPECT_FALSE(summary.value(where, "").empty()) << where;
            EXPECT_TRUE(summary.contains("processor"));
        }
        EXPECT_NE(ending.output.find("box: There is one method only"), std::string::npos) << ending.output;
        EXPECT_TRUE(fs::exists(results / "report.html"));
        EXPECT_FALSE(fs::exists(results / "references"));
    }
}

TEST(StudyProgram, RefusesAReferenceThatDoesNotFit) {
    const fs::path folder = fresh_folder("study");
    const auto refusal = [&](int height, float value) {
        Image image{20, height, {"R", "G", "B"}, std::vector<float>(static_cast<std::size_t>(3 * 20 * height), 1.0f)};
        image.data[7] = value;
        write_exr(folder / "bad.exr", image);
        return Program(study(write_study_with("bad.exr", folder), folder / "results")).wait(kSoon);
    };
    const Ending small = refusal(15, 1.0f);
    EXPECT_EQ(small.code, 2);
    EXPECT_NE(small.output.find("given.toml:10:13: the reference has 20 x 15 pixels, the scene 20 x 16"),
              std::string::npos)
        << small.output;
    const Ending nan = refusal(16, NAN);
    EXPECT_EQ(nan.code, 2);
    EXPECT_NE(nan.output.find("1 pixels that are no finite numbers"), std::string::npos) << nan.output;
    EXPECT_FALSE(fs::exists(folder / "results" / "cells")) << "nothing was rendered";
}

TEST(StudyProgram, BadInputSaysWhere) {
    const fs::path folder = fresh_folder("study");
    std::ofstream(folder / "bad.toml") << "[scene.box]\nfile = \"none.xml\"\n";
    const Ending ending = Program(study(folder / "bad.toml", folder / "results")).wait(kSoon);
    EXPECT_EQ(ending.code, 2);
    EXPECT_NE(ending.output.find("bad.toml:2:8: there is no file"), std::string::npos) << ending.output;
}

}  // namespace
}  // namespace treefarm::test
