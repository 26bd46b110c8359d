// SPDX-License-Identifier: Apache-2.0
// Shots: frames by number, of which a broken one stops no other, and finished ones are kept.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>

#include "common/image/exr.h"
#include "tests/mpi/program.h"

namespace treefarm::test {
namespace {

/// A lit square that turns with $angle; frame 3 has another file, which is broken.
void write_scenes(const fs::path& folder) {
    const std::string text = R"(<scene version="3.0.0"><default name="angle" value="0"/>
<sensor type="perspective"><float name="fov" value="40"/>
<transform name="to_world"><lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
<film type="hdrfilm"><integer name="width" value="12"/><integer name="height" value="8"/></film></sensor>
<shape type="rectangle"><transform name="to_world"><rotate y="1" angle="$angle"/></transform>
<bsdf type="twosided"><bsdf type="diffuse"><rgb name="reflectance" value="0.5, 0.4, 0.3"/></bsdf></bsdf></shape>
<emitter type="constant"><rgb name="radiance" value="1, 1.5, 2"/></emitter></scene>)";
    for (const char* number : {"01", "02", "04"})
        std::ofstream(folder / ("turn." + std::string(number) + ".xml")) << text;
    std::ofstream(folder / "turn.03.xml") << text.substr(0, 90) << "<shape type=\"spoon\"/></scene>";
    std::ofstream(folder / "turn.xml") << text;
}

std::vector<std::string> render_shot(const fs::path& scene, const std::vector<std::string>& options) {
    return std::vector<std::string>{TREEFARM_PROGRAM,
                                    "render",
                                    scene.string(),
                                    "--threads",
                                    "1",
                                    "--spp",
                                    "6",
                                    "--set",
                                    "farm.heartbeat_seconds=0.2"} +
           options;
}

nlohmann::json read_index(const fs::path& directory) {
    std::ifstream file(directory / "shot.json");
    return nlohmann::json::parse(file);
}

std::vector<std::string> states(const fs::path& directory) {
    std::vector<std::string> list;
    const nlohmann::json index = read_index(directory);
    for (const nlohmann::json& frame : index["frames"])
        list.push_back(frame["state"]);
    return list;
}

class ShotTest : public ::testing::TestWithParam<int> {
  protected:
    Ending run(const std::vector<std::string>& command) const {
        return Program((GetParam() == 0 ? Words() : mpirun(GetParam())) + command).wait(kSoon);
    }
};

TEST_P(ShotTest, ABrokenFrameStopsNoOtherAndFinishedOnesAreKept) {
    const fs::path folder = fresh_folder("shot"), shot = folder / "shot";
    write_scenes(folder);
    const auto command =
        render_shot(folder / "turn.%02d.xml", {"--frames", "1-4", "-D", "angle=%d", "--set", "sampler.seed=%03d",
                                               "--run-dir", shot.string(), "-o", (folder / "out/f.####.exr").string()});
    const Ending first = run(command);
    EXPECT_EQ(first.code, 1) << first.output;
    EXPECT_EQ(states(shot), (Words{"done", "done", "failed", "done"})) << first.output;
    const nlohmann::json broken = read_index(shot)["frames"][2];
    EXPECT_NE(broken["message"].get<std::string>().find("turn.03.xml:2:"), std::string::npos) << broken;
    EXPECT_NE(first.output.find("0003                                failed: "), std::string::npos) << first.output;
    EXPECT_FALSE(fs::exists(folder / "out/f.0003.exr"));

    for (const int frame : {1, 2, 4}) {
        const std::string number = std::to_string(frame), digits = "000" + number;
        const fs::path lone = folder / ("lone" + number);
        const Ending ending =
            run(render_shot(folder / ("turn.0" + number + ".xml"),
                            {"-D", "angle=" + number, "--set", "sampler.seed=" + number, "--run-dir", lone.string()}));
        ASSERT_EQ(ending.code, 0) << ending.output;
        const nlohmann::json summary = read_summary(shot / ("frame." + digits));
        EXPECT_EQ(summary["image_hash"], read_summary(lone)["image_hash"]) << "frame " << frame;
        EXPECT_EQ(summary["scene_hash"], read_summary(lone)["scene_hash"]) << "frame " << frame;
        const ExrRgb image = read_exr_rgb(folder / ("out/f." + digits + ".exr"));
        EXPECT_EQ(image.attributes.at("treefarm.image_hash"), summary["image_hash"].get<std::string>());
        EXPECT_EQ(read_index(shot)["frames"][static_cast<std::size_t>(frame) - 1]["spp"], summary["spp"]);
    }

    // Again: nothing that is done is rendered, what is missing of it is made, and what failed is tried.
    const nlohmann::json before = read_summary(shot / "frame.0001");
    fs::remove(folder / "out/f.0001.exr");
    fs::copy_file(folder / "turn.02.xml", folder / "turn.03.xml", fs::copy_options::overwrite_existing);
    const Ending second = run(command);
    EXPECT_EQ(second.code, 0) << second.output;
    EXPECT_EQ(states(shot), (Words{"kept", "kept", "done", "kept"})) << second.output;
    EXPECT_NE(second.output.find("kept: it was done before"), std::string::npos) << second.output;
    EXPECT_EQ(read_summary(shot / "frame.0001"), before) << "rendered again: its seconds differ";
    EXPECT_TRUE(fs::exists(folder / "out/f.0001.exr"));
    EXPECT_TRUE(fs::exists(folder / "out/f.0003.exr"));

    // Another request does not replace what is done unless it may.
    Words other = command + Words{"--set", "budget.spp=9"};
    other.erase(std::find(other.begin(), other.end(), "--spp"), std::find(other.begin(), other.end(), "--spp") + 2);
    const Ending refused = run(other);
    EXPECT_EQ(refused.code, 1) << refused.output;
    EXPECT_EQ(states(shot), (Words(4, "failed"))) << refused.output;
    EXPECT_NE(refused.output.find("holds a render (done, 6 spp)"), std::string::npos) << refused.output;
    EXPECT_EQ(read_summary(shot / "frame.0001"), before);
    other.emplace_back("--overwrite");
    const Ending replaced = run(other);
    EXPECT_EQ(replaced.code, 0) << replaced.output;
    EXPECT_EQ(states(shot), (Words(4, "done")));
    EXPECT_EQ(read_summary(shot / "frame.0004")["spp"], 9);
}

INSTANTIATE_TEST_SUITE_P(Ranks, ShotTest, ::testing::Values(0, 3));

TEST(Shot, AnInterruptIsResumable) {
    const fs::path folder = fresh_folder("shot"), shot = folder / "shot";
    write_scenes(folder);
    auto command = render_shot(folder / "turn.xml", {"--frames", "1-40", "-D", "angle=%d", "--run-dir", shot.string()});
    {
        Program program(mpirun(2) + command);
        ASSERT_TRUE(program.wait_until([&] { return fs::exists(shot / "frame.0003" / "summary.json"); }, kSoon));
        program.signal(SIGINT);
        const Ending ending = program.wait(kSoon);
        EXPECT_NE(ending.code, 0) << ending.output;
    }
    const nlohmann::json before = read_summary(shot / "frame.0002");
    const Ending ending = Program(mpirun(2) + command).wait(kSoon);
    EXPECT_EQ(ending.code, 0) << ending.output;
    EXPECT_EQ(read_summary(shot / "frame.0002"), before);
    for (const std::string& state : states(shot))
        EXPECT_TRUE(state == "kept" || state == "done") << state;
}

TEST(Shot, WhatCannotBeIsRefusedBeforeAFrameIsRendered) {
    const fs::path folder = fresh_folder("shot"), shot = folder / "shot";
    write_scenes(folder);
    const auto refusal = [&](const Words& options) {
        const Ending ending =
            Program(render_shot(folder / "turn.xml", Words{"--run-dir", shot.string()} + options)).wait(kSoon);
        EXPECT_EQ(ending.code, 2) << ending.output;
        EXPECT_FALSE(fs::exists(shot)) << ending.output;
        return ending.output;
    };
    EXPECT_NE(refusal({"--frames", "4-1"}).find("--frames: the range \"4-1\" ends before it begins"),
              Words::value_type::npos);
    EXPECT_NE(refusal({"--frames", "1-4", "-o", "all.exr"}).find("all frames would be written to all.exr"),
              std::string::npos);
    EXPECT_NE(refusal({"--frames", "1", "--debug-sample", "0,0,0,0"}).find("--debug-sample"), std::string::npos);
    EXPECT_NE(refusal({"--frames", "1", "--schedule", "s.toml"}).find("--schedule"), std::string::npos);
}

TEST(Shot, DoesNotMixWithOtherFolders) {
    const fs::path folder = fresh_folder("shot"), lone = folder / "lone", shot = folder / "shot";
    write_scenes(folder);
    ASSERT_EQ(Program(render_shot(folder / "turn.xml", {"--run-dir", lone.string()})).wait(kSoon).code, 0);
    const Words frames = {"--frames", "1", "-D", "angle=%d", "--run-dir"};
    const Ending on_render = Program(render_shot(folder / "turn.xml", frames + Words{lone.string()})).wait(kSoon);
    EXPECT_EQ(on_render.code, 2);
    EXPECT_NE(on_render.output.find("holds a render (done, 6 spp), which a shot does not replace"), std::string::npos)
        << on_render.output;
    ASSERT_EQ(Program(render_shot(folder / "turn.xml", frames + Words{shot.string()})).wait(kSoon).code, 0);
    const Ending on_shot = Program(render_shot(folder / "turn.xml", {"--run-dir", shot.string()})).wait(kSoon);
    EXPECT_EQ(on_shot.code, 2);
    EXPECT_NE(on_shot.output.find("holds a shot"), std::string::npos) << on_shot.output;
}

}  // namespace
}  // namespace treefarm::test
