// SPDX-License-Identifier: Apache-2.0
// What the program says to whoever types something that it does not take: every number is checked where it is typed,
// unknown options are answered by what there is, files of other kinds by what to do with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

std::string box_scene() {
    return test::own_scene("cornell-box.xml");
}

/// One line that begins with the program's name and holds all of these texts, and exit code 2.
void expect_refusal(const std::string& arguments, const std::vector<std::string>& texts) {
    const test::Ended ended = test::run_treefarm(arguments);
    EXPECT_EQ(ended.code, 2) << arguments << "\n" << ended.output;
    EXPECT_TRUE(ended.output.starts_with("treefarm: ")) << arguments << "\n" << ended.output;
    EXPECT_EQ(std::count(ended.output.begin(), ended.output.end(), '\n'), 1) << arguments << "\n" << ended.output;
    EXPECT_EQ(ended.output.find("Could not convert"), std::string::npos) << ended.output;
    for (const std::string& text : texts)
        EXPECT_NE(ended.output.find(text), std::string::npos) << arguments << " lacks " << text << "\n" << ended.output;
}

void expect_render_refuses(const std::string& options, const std::vector<std::string>& texts) {
    expect_refusal("render " + box_scene() + " " + options, texts);
}

TEST(Usage, SamplesAreWholeNumbersInRange) {
    const std::string cure = "give whole samples per pixel from 1 to 1073741824, for instance --spp 64";
    expect_render_refuses("--spp 0", {"--spp: \"0\" is less than 1", cure});
    expect_render_refuses("--spp -4", {"\"-4\" is less than 1", cure});
    expect_render_refuses("--spp 4.5", {"\"4.5\" is not a whole number", cure});
    expect_render_refuses("--spp 99999999999", {"\"99999999999\" is more than 1073741824", cure});
    expect_render_refuses("--spp 1e3", {"write --spp 1000"});
    for (const char* text : {"abc", "nan", "inf", "1e400", "64x"})
        expect_render_refuses("--spp " + std::string(text), {"\"" + std::string(text) + "\" is not a number", cure});
    expect_render_refuses("--spp ''", {"--spp: the value is empty", cure});
}

TEST(Usage, SecondsAreAboveZeroAndMayHaveAUnit) {
    for (const char* text : {"soon", "nan", "inf", "1e400", "2 days", "5ms"})
        expect_render_refuses("--seconds '" + std::string(text) + "'",
                              {"--seconds: \"" + std::string(text) + "\" is no time", "--seconds 2min"});
    expect_render_refuses("--seconds 0", {"in 0 seconds nothing is rendered"});
    expect_render_refuses("--seconds -1", {"\"-1\" is less than a thousandth of a second"});
    expect_render_refuses("--seconds 1e9", {"\"1e9\" is more than 10^8 seconds"});
    expect_render_refuses("--seconds ''", {"the value is empty"});
    for (const char* text : {"90", "90s", "2min", "2m", "1h", "'1.5 min'"})
        EXPECT_EQ(test::run_treefarm("plan --no-probe " + box_scene() + " --seconds " + text).code, 0) << text;
}

TEST(Usage, ErrorsAreFractionsOrPercentages) {
    expect_render_refuses("--error 0", {"--error: an error of 0 takes forever", "--error 0.05 or --error 5%"});
    expect_render_refuses("--error 5", {"\"5\" is 500 % of the mean", "for 5 % write --error 0.05 or --error 5%"});
    expect_render_refuses("--error 500%", {"is 500 % of the mean"});
    expect_render_refuses("--error -0.1", {"\"-0.1\" is negative"});
    expect_render_refuses("--error 1e-9", {"less than 10^-6"});
    for (const char* text : {"abc", "nan", "%", "1e400", "5%%"})
        expect_render_refuses("--error '" + std::string(text) + "'", {"is not a number"});
    for (const char* text : {"0.05", "5%", "'5 %'", "1"})
        EXPECT_EQ(test::run_treefarm("plan --no-probe " + box_scene() + " --error " + text).code, 0) << text;
}

TEST(Usage, ThreadsAreWholeNumbersInRange) {
    for (const char* text : {"0", "-1", "abc", "4097", "1.5", "nan", "''"})
        expect_render_refuses("--threads " + std::string(text),
                              {"--threads: ", "give whole threads from 1 to 4096, for instance --threads 4"});
    expect_refusal("study x.toml --threads 0", {"--threads: \"0\" is less than 1"});
}

TEST(Usage, OtherCommandsCheckTheirNumbersToo) {
    for (const char* option : {"--block 0", "--block x", "--flip-ppd 0", "--flip-ppd nan", "--reference-spp 0",
                               "--reference-error 2", "--reference-error -1"})
        expect_refusal("compare a.exr b.exr " + std::string(option), {"--", "for instance"});
    for (const char* option : {"--size 8", "--size 1e9", "--spp 0", "--spp many", "--threads 0"})
        expect_refusal("inspect somewhere " + std::string(option), {"--", "for instance"});
    expect_refusal("inspect somewhere --size 17", {"no power of two"});
}

TEST(Usage, SettingsSayWhatIsAllowed) {
    for (const char* setting :
         {"budget.seconds=-1", "budget.seconds=1e400", "budget.seconds=nan", "budget.error=5", "budget.error=500%",
          "budget.error=-1", "budget.spp=0", "budget.spp=4.5", "farm.tile_size=0", "image.width=-1", "sampler.seed=-1",
          "guiding.bsdf_fraction=2", "guiding.spp_unit="})
        expect_refusal("plan " + box_scene() + " --set " + setting, {"--set ", "is not allowed; allowed: "});
    for (const char* setting : {"budget.error=5%", "'budget.error = 0.05'", "budget.seconds=2min"})
        EXPECT_EQ(test::run_treefarm("plan " + box_scene() + " --set " + setting).code, 0) << setting;
}

/// Budgets that others make void would be ignored in silence if they were accepted.
TEST(Usage, ABudgetThatAnotherMakesVoidIsRefused) {
    expect_render_refuses("--set budget.spp=8 --seconds 1", {"--set budget.spp=8: budget.seconds decides", "max_spp"});
    const test::Ended warned = test::run_treefarm("plan " + box_scene() + " --set budget.max_spp=8");
    EXPECT_EQ(warned.code, 0);
    EXPECT_NE(warned.output.find("budget.max_spp has no effect without --seconds or --error"), std::string::npos)
        << warned.output;
}

TEST(Usage, UnknownOptionsNameTheNearest) {
    expect_render_refuses("--run-dri x", {"--run-dri is no option of render; did you mean --run-dir?"});
    expect_render_refuses("--run-dri=x", {"--run-dri is no option of render; did you mean --run-dir?"});
    expect_render_refuses("-spp 4", {"did you mean --spp?"});
    expect_refusal("render --sponge", {"--sponge is no option of render"});
    expect_refusal("plan " + box_scene() + " --run-dir x",
                   {"--run-dir is no option of plan; it is one of treefarm render"});
    expect_refusal("--spp 4", {"--spp stands before the command"});
    expect_refusal(box_scene(), {"is a file, not a command; write treefarm render "});
    expect_refusal("''", {"no command is called \"\""});
    EXPECT_EQ(test::run_treefarm("").code, 2);
}

TEST(Usage, WhatOtherRenderersHaveIsAnsweredByWhatThereIs) {
    for (const auto& [option, text] :
         std::vector<std::pair<std::string, std::string>>{{"--frame-start 1", "write --frames 1-24 -D name=%d"},
                                                          {"--continue", "treefarm resume RUN_DIR"},
                                                          {"--denoise", "no denoiser in this version"},
                                                          {"--crop 0,0,8,8", "crop_offset_x"},
                                                          {"--camera 1", "--sensor N"},
                                                          {"--output-format PNG", "-o writes an EXR"},
                                                          {"--samples 8", "--spp N"},
                                                          {"--width 8", "--set image.width=VALUE"},
                                                          {"--max-depth 8", "--set integrator.max_depth=VALUE"},
                                                          {"--guiding.type none", "--set guiding.type=VALUE"}})
        expect_render_refuses(option, {option.substr(0, option.find(' ')) + " is no option of render; ", text});
}

TEST(Usage, MissingAndSurplusWords) {
    expect_refusal("render", {"render needs a scene (.xml) or a job (.toml)"});
    expect_refusal("compare a.exr", {"compare needs an image and a reference (.exr)"});
    expect_render_refuses("other.xml", {"\"other.xml\" is more than render takes"});
    expect_render_refuses("--spp", {"--spp has no value"});
    expect_render_refuses("--spp= --quiet", {"--spp= has no value behind \"=\""});
    expect_render_refuses("--spp 4 --spp 8", {"--spp is given more than once"});
    expect_render_refuses("-o a.exr --output b.exr", {"--output is given more than once"});
    expect_render_refuses("--run-dir --quiet", {"--run-dir: no value before --quiet"});
    expect_render_refuses("-o ''", {"-o: the value is empty"});
    expect_render_refuses("-o=a.exr", {"write -o a.exr"});
    expect_render_refuses("--quiet=often", {"--quiet takes no value"});
    expect_render_refuses("-D width=8", {"does not use $width", "--set image.width=8"});
    expect_render_refuses("-D sise=8", {"does not use $sise", "did you mean $size?"});
    expect_render_refuses("-D size=0", {":"});
    expect_render_refuses("-D size=abc", {":"});
    expect_render_refuses("-D size", {"write -D name=value"});
}

class WrongFiles : public test::FolderTest {
  protected:
    std::string write(const std::string& name, const std::string& text) const {
        return FolderTest::write(name, text).string();
    }
};

TEST_F(WrongFiles, FormatsOfOthersSayHowToConvert) {
    for (const auto& [name, text] : std::vector<std::pair<std::string, std::string>>{{"a.blend", "mitsuba-blender"},
                                                                                     {"a.pbrt", "mitsuba-blender"},
                                                                                     {"a.usda", "mitsuba-blender"},
                                                                                     {"a.GLB", "mitsuba-blender"},
                                                                                     {"a.obj", "filename of a shape"},
                                                                                     {"a.ply", "filename of a shape"},
                                                                                     {"a.exr", "it is an image"},
                                                                                     {"a.json", "job (.toml)"},
                                                                                     {"a.xyz", "job (.toml)"},
                                                                                     {"a", "job (.toml)"}})
        for (const char* command : {"render ", "plan "})
            expect_refusal(command + write(name, "x"), {"a", text});
    expect_refusal("check " + write("a.blend", "x"), {"mitsuba-blender"});
    expect_refusal("render " + write("job.toml", "scene.file = \"a.pbrt\"\n"), {"a.pbrt: ", "mitsuba-blender"});
    expect_refusal("render ''", {"the name is empty"});
    expect_refusal("render " + folder_.string(), {"is a run directory", "treefarm render ", "job.toml"});
    std::filesystem::remove(folder_ / "job.toml");
    expect_refusal("render " + folder_.string(), {"is a folder"});
    write("study.json", "{}");
    expect_refusal("render " + folder_.string(), {"is the folder of a study", "treefarm report"});
    std::filesystem::remove(folder_ / "study.json");
    write("shot.json", "{}");
    expect_refusal("render " + folder_.string(), {"is the folder of a shot", "frame.0001/job.toml"});
    std::filesystem::remove(folder_ / "shot.json");
}

TEST_F(WrongFiles, FilesOfSettingsCheckNumbersToo) {
    const auto job = [&](const std::string& line) {
        return "plan " + write("job.toml", "scene.file = \"" + box_scene() + "\"\n" + line + "\n");
    };
    for (const char* line : {"budget.error = \"5%\"", "budget.seconds = \"2min\"", "budget.error = 0.05"})
        EXPECT_EQ(test::run_treefarm(job(line)).code, 0) << line;
    for (const char* line :
         {"budget.error = 5", "budget.error = \"five\"", "budget.seconds = -1", "budget.seconds = inf"})
        expect_refusal(job(line), {"job.toml:2:", "is not allowed; allowed: 0, or "});
    for (const char* line : {"warmup = -1", "seeds = 0", "seeds = 2.5", "seeds = [-1]"})
        expect_refusal(
            "study --dry-run " + write("study.toml", std::string(line) + "\nbudget.spp = 1\n[scene.a]\nfile = \"" +
                                                         box_scene() + "\"\n[reference]\nsampler.seed = 9\n"),
            {"study.toml:1:", "which is not allowed; give an integer from "});
}

TEST(Usage, KeysAreGuessedByTheirLastPart) {
    const std::string plan = "plan " + box_scene();
    expect_refusal(plan + " --set spp=4", {"unknown key \"spp\"; did you mean budget.spp?"});
    expect_refusal(plan + " --set seed=4", {"did you mean sampler.seed?"});
    expect_refusal(plan + " --set image.spp=4", {"did you mean budget.spp?"});
    expect_refusal(plan + " --set sed=4", {"did you mean sampler.seed?"});
    expect_refusal(plan + " --set type=path", {"guiding.type", " or ", "integrator.type"});
    expect_refusal(plan + " --set qqqqqqqqqqqqqqqqqqqqqqqq=4", {"treefarm keys lists the keys"});
    expect_refusal("render " + box_scene() + " --integrator path",
                   {"--integrator is no option of render; write --set integrator.type=NAME; treefarm keys"});
    expect_refusal("render " + box_scene() + " --sampler x", {"it is a table of keys: treefarm keys sampler."});
}

TEST(Study, ADryRunTellsTheTimeOfCellsAndReferences) {
    const std::string study = test::fresh_test_folder() / "study.toml";
    test::write_file(study, "seeds = 3\nwarmup = 1\nbudget.seconds = 20\n[scene.a]\nfile = \"" + box_scene() +
                                "\"\nimage.width = 16\nimage.height = 16\n[method.plain]\nguiding.type = \"none\"\n"
                                "[method.guided]\n[reference]\nsampler.seed = 9\nbudget.spp = 4000\n");
    const test::Ended ended = test::run_treefarm("study --dry-run --probe 0.05 --threads 2 " + study);
    EXPECT_EQ(ended.code, 0);
    // Two methods, three seeds, a warm-up: 7 x 20 s x 2 threads.
    EXPECT_NE(ended.output.find("about 4:40 of a core for the cells, "), std::string::npos) << ended.output;
    EXPECT_NE(ended.output.find("] for the references; this machine has 2 threads"), std::string::npos) << ended.output;
    const test::Ended without = test::run_treefarm("study --dry-run --no-probe --threads 2 " + study);
    EXPECT_NE(without.output.find("about 4:40 of a core for the cells; 1 render not counted"), std::string::npos)
        << without.output;
}

TEST(Keys, AreListedWithDefaultAndMeaning) {
    const test::Ended all = test::run_treefarm("keys");
    EXPECT_EQ(all.code, 0);
    EXPECT_NE(all.output.find("budget.spp = 64\n    samples per pixel"), std::string::npos) << all.output;
    const test::Ended some = test::run_treefarm("keys SPP_UNIT");
    EXPECT_TRUE(some.output.starts_with("guiding.spp_unit = 1\n")) << some.output;
    EXPECT_NE(some.output.find("    allowed: 1 to 65536\n"), std::string::npos);
    const nlohmann::json json = nlohmann::json::parse(test::run_treefarm("keys sampler --json").output);
    ASSERT_EQ(json.size(), 1u);
    EXPECT_EQ(json[0]["key"], "sampler.seed");
    EXPECT_EQ(json[0]["type"], "integer");
    EXPECT_EQ(json[0]["default"], "0");
    expect_refusal("keys sampler.sed", {"did you mean sampler.seed?"});
}

TEST(Help, ListsExitCodesAndWhereDefaultsAre) {
    for (const char* command : {"", "render "}) {
        const test::Ended help = test::run_treefarm(command + std::string("--help"));
        EXPECT_EQ(help.code, 0);
        EXPECT_NE(help.output.find("Exit codes: 0 done, 1 the run failed, 2 bad usage"), std::string::npos);
        EXPECT_NE(help.output.find("treefarm keys"), std::string::npos);
    }
}

TEST_F(WrongFiles, JobsAndStudiesAreToldApart) {
    const std::string source(TREEFARM_SOURCE_DIR);
    for (const char* command : {"render ", "plan "})
        expect_refusal(command + source + "/configs/studies/demo.toml",
                       {"demo.toml:", "is a key of studies", "write treefarm study "});
    expect_refusal("study --dry-run " + source + "/configs/jobs/door-ajar.toml",
                   {"door-ajar.toml:", "is a key of jobs", "write treefarm render "});
    expect_refusal("study " + box_scene(), {"is a scene", "write treefarm render "});
    const std::string schedule = write("schedule.toml", "[[pass]]\nspp = 1\nnext_event = true\nrecord = false\n");
    expect_refusal("render " + schedule, {"schedule.toml:1:", "--schedule "});
    expect_refusal("study " + schedule, {"schedule.toml:1:", "--schedule "});
}

}  // namespace
}  // namespace treefarm
