// SPDX-License-Identifier: Apache-2.0
#include "coordinator/study/study.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "tests/support/refusal.h"
#include "tests/support/support.h"

namespace treefarm {
namespace {

const std::string kScene = "[scene.box]\nfile = \"cornell-box.xml\"\n";
const std::string kRest = "[budget]\nspp = 8\n[reference]\nsampler.seed = 1000\n";

Study parse(const std::string& text) {
    return parse_study(text, test::own_scene("study.toml"));
}

std::string complaint(const std::string& text) {
    return test::refusal_of([&] { parse(text); }, "accepted");
}

void expect_complaint(const std::string& text, const std::string& part) {
    const std::string message = complaint(text);
    EXPECT_NE(message.find(part), std::string::npos) << text << "\nsays: " << message;
}

TEST(Study, AMethodsNameIsThatOfItsFirstVariant) {
    const Study study = parse("baseline = \"ape\"\n" + kScene + "[method.zebra]\n[method.ape]\n" + kRest +
                              "[vary]\nguiding.spp_unit = [2, 3]\n");
    EXPECT_EQ(study.baseline, "ape spp_unit=2");
}

TEST(Study, ReadsItsMatrix) {
    const Study study = parse("seeds = [5, 7]\nbaseline = \"zebra\"\n" + kScene +
                              "image.width = 32\n[method.zebra]\n[method.ape]\nguiding.type = \"none\"\n" + kRest);
    ASSERT_EQ(study.methods.size(), 2u);
    EXPECT_EQ(study.methods[0].name, "zebra") << "in the file's order";
    EXPECT_EQ(study.methods[1].settings.at(0).key, "guiding.type");
    EXPECT_EQ(study.scenes.at(0).file, test::own_scene("cornell-box.xml"));
    EXPECT_EQ(study.scenes[0].settings.at(0).key, "image.width");
    EXPECT_EQ(study.seeds, (std::vector<std::uint64_t>{5, 7}));
    EXPECT_EQ(study.directory, "runs/study");
    EXPECT_EQ(study.budgets.at(0).key, "budget.spp");
}

TEST(Study, VariesKeysInEveryCombination) {
    const Study study = parse(kScene + kRest + "[vary]\nguiding.spp_unit = [1, 4]\nfarm.tile_size = [8, 16, 32]\n");
    ASSERT_EQ(study.methods.size(), 6u);
    std::set<std::string> names;
    for (const StudyMethod& method : study.methods) {
        EXPECT_EQ(method.settings.size(), 2u);
        names.insert(method.name);
    }
    EXPECT_EQ(names.size(), 6u);
    EXPECT_TRUE(names.contains("tile_size=8 spp_unit=1")) << *names.begin();
}

TEST(Study, InterleavesMethods) {
    const Study study = parse("seeds = 3\n" + kScene +
                              "[scene.two]\nfile = \"cornell-box.xml\"\n[method.a]\n[method.b]\n[method.c]\n" + kRest);
    const std::vector<StudyCell> cells = study_cells(study);
    ASSERT_EQ(cells.size(), 18u);
    std::map<std::size_t, std::set<std::size_t>> turns;
    for (std::size_t k = 0; k < cells.size(); ++k) {
        EXPECT_EQ(cells[k].scene, k / 9) << "a scene is done before the next begins";
        EXPECT_EQ(cells[k].repetition, k / 3 % 3) << "a repetition holds every method";
        EXPECT_EQ(cells[k].seed, cells[k].repetition + 1);
        turns[cells[k].method].insert(k % 3);
    }
    for (const auto& [method, at] : turns)
        EXPECT_EQ(at.size(), 3u) << "method " << method << " stands at every place of a repetition";
}

TEST(Study, TakesSeveralBudgets) {
    const Study study =
        parse("seeds = 2\n" + kScene +
              "[method.a]\n[method.b]\n[budget]\nseconds = [1, 2.5]\n[reference]\nsampler.seed = 1000\n");
    ASSERT_EQ(study.budgets.size(), 2u);
    EXPECT_EQ(study.budgets[1].key, "budget.seconds");
    EXPECT_EQ(study.budgets[1].value, "2.5");
    const std::vector<StudyCell> cells = study_cells(study);
    ASSERT_EQ(cells.size(), 8u);
    for (std::size_t k = 0; k < cells.size(); ++k)
        EXPECT_EQ(cells[k].budget, k / 2 % 2) << "a repetition holds every budget with every method";
    expect_complaint(kScene + "[budget]\nspp = []\n", "study.toml:4:7: a list without budgets");
    expect_complaint(kScene + "[budget]\nspp = [4, 8, 4]\n", "study.toml:4:14: the budget 4 is listed twice");
    expect_complaint(kScene + "[budget]\nseconds = [4, 0]\n", "study.toml:4:15: ");
    expect_complaint(kScene + "[budget]\nerror = [0.1, \"x\"]\n", "study.toml:4:15: ");
}

TEST(Study, SaysWhatIsWrongAndWhere) {
    expect_complaint("sceens = 1\n", "study.toml:1:1: unknown key \"sceens\"");
    expect_complaint("[budget]\nspp = 4\n", "a study without scenes");
    expect_complaint("[scene.box]\nfile = \"none.xml\"\n" + kRest, "study.toml:2:8: there is no file");
    expect_complaint(kScene + "reference = \"none.exr\"\n" + kRest, "study.toml:3:13: there is no file");
    expect_complaint(kScene + "[method.a]\nguiding.typ = \"none\"\n" + kRest,
                     "study.toml:4:9: unknown key \"guiding.typ\"");
    expect_complaint(kScene + "[method.a]\nguiding.type = \"nine\"\n" + kRest, "study.toml:4:16: ");
    expect_complaint(kScene + "[method.a]\nbudget.spp = 3\n" + kRest, "study.toml:4:14: budget.spp has another place");
    expect_complaint(kScene + "[method.a]\nimage.width = 3\n" + kRest, "image.width has another place");
    expect_complaint(kScene + "[job]\nsampler.seed = 3\n" + kRest, "sampler.seed has another place");
    expect_complaint(kScene + "[job]\noutput.file = \"a.exr\"\n" + kRest, "output.file has another place");
    expect_complaint(kScene + "[budget]\nspp = 4\nseconds = 3\n", "one kind of budget for all cells");
    expect_complaint(kScene + "[budget]\nspp = 0\n[reference]\nsampler.seed = 1000\n", "study.toml:4:7: ");
    expect_complaint(kScene + "[budget]\nspp = 4\n", "scene.box has no reference");
    expect_complaint(kScene + "[budget]\nspp = 4\n[reference]\nsampler.seed = 2\n", "share a seed");
    expect_complaint("seeds = [1, 1]\n" + kScene + kRest, "study.toml:1:9: seeds are");
    expect_complaint("seeds = 0\n" + kScene + kRest, "study.toml:1:9: ");
    expect_complaint("baseline = \"x\"\n" + kScene + "[method.a]\n" + kRest, "no method is called \"x\"");
    expect_complaint(kScene + kRest + "[vary]\nguiding.spp_unit = 4\n", "not a list of values");
    expect_complaint(kScene + kRest + "[vary]\nguiding.spp_unit = [\"a\"]\n", "not an integer");
    expect_complaint("seeds = = 1", "this is not TOML");
}

TEST(Study, ReadsAllThatComeAlong) {
    std::size_t count = 0;
    for (const auto& file : std::filesystem::directory_iterator(TREEFARM_SOURCE_DIR "/configs/studies")) {
        EXPECT_NO_THROW(read_study(file.path())) << file.path();
        ++count;
    }
    EXPECT_GT(count, 10u);
}

}  // namespace
}  // namespace treefarm
