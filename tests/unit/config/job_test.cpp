// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "common/base/text/parse_text.h"
#include "common/config/check_job.h"
#include "common/config/job_keys.h"
#include "common/config/job_reader.h"
#include "tests/support/refusal.h"
#include "tests/support/support.h"
#include "tests/support/test_folder.h"

namespace treefarm {
namespace {

Job job_of(const std::string& toml) {
    Job job;
    apply_layer(job, parse_job_settings(toml, "job.toml"));
    return job;
}

std::string message_of(const std::string& toml) {
    return test::refusal_of([&] { job_of(toml); }, "no error");
}

TEST(Job, PathsMustEnd) {
    EXPECT_NO_THROW(check_job(Job{}));
    EXPECT_NO_THROW(check_job(job_of("[integrator]\nmax_depth = -1\nrr_depth = 10000\n")));
    EXPECT_NO_THROW(check_job(job_of("[integrator]\nmax_depth = 5\nrr_depth = 1000000\n")));
    EXPECT_THROW(check_job(job_of("[integrator]\nmax_depth = -1\nrr_depth = 10001\n")), InputError);
    EXPECT_NO_THROW(check_job(job_of("[guiding]\nroulette = \"constant\"\n")));
    EXPECT_NO_THROW(check_job(job_of("[guiding]\nroulette = \"adjoint\"\nsplitting = 8\n")));
    EXPECT_THROW(check_job(job_of("[guiding]\nroulette = \"constant\"\nsplitting = 2\n")), InputError);
}

TEST(Job, ReadsEveryKind) {
    const Job job = job_of(
        "[scene]\nfile = \"a b.xml\"\nlenient = true\n[scene.defines]\nspp = 4\nname = \"x\"\n"
        "[integrator]\nmax_depth = -1\nnext_event = \"kickstart\"\nmis = \"balance\"\n"
        "[guiding]\ntype = \"none\"\nbsdf_fraction = 1\ncombination = \"fixed\"\n"
        "[budget]\nspp = 12\n[sampler]\nseed = 9223372036854775807\n[farm]\nheartbeat_seconds = 0.25\nisa = "
        "\"sse2\"\n");
    EXPECT_EQ(job.scene.file, "a b.xml");
    EXPECT_TRUE(job.scene.lenient);
    EXPECT_EQ(job.scene.defines.at("spp"), "4");
    EXPECT_EQ(job.scene.defines.at("name"), "x");
    EXPECT_EQ(job.integrator.max_depth, -1);
    EXPECT_EQ(job.integrator.next_event, NextEvent::kickstart);
    EXPECT_EQ(job.integrator.mis, MisHeuristic::balance);
    EXPECT_EQ(job.guiding.type, GuidingType::none);
    EXPECT_EQ(job.guiding.bsdf_fraction, 1.0f);
    EXPECT_EQ(job.guiding.combination, Combination::fixed);
    EXPECT_EQ(job.budget.spp, 12u);
    EXPECT_EQ(job.sampler.seed, 9223372036854775807u);
    EXPECT_EQ(job.farm.heartbeat_seconds, 0.25);
    EXPECT_EQ(job.farm.isa, "sse2");
}

TEST(Job, WrittenJobReadsBackTheSame) {
    Job job;
    job.scene.file = "C:\\odd \"name\"\n.xml";
    job.scene.defines = {{"a", "1"}, {"with space", "\"quoted\""}};
    job.scene.lenient = true;
    job.image = {640, 360};
    job.integrator = {"path", 12, 3, NextEvent::kickstart, MisHeuristic::balance, LightSelection::even, true, true};
    job.guiding.type = GuidingType::none;
    job.guiding.preset = "paper";
    job.guiding.bsdf_fraction = 0.1f;
    job.guiding.learn_bsdf_fraction = false;
    job.guiding.spatial_filter = SpatialFilter::stochastic;
    job.guiding.directional_filter = DirectionalFilter::box;
    job.guiding.target = GuidingTarget::variance;
    job.guiding.spatial_threshold = 4001;
    job.guiding.directional_threshold = 0.0007f;
    job.guiding.spp_unit = 3;
    job.guiding.combination = Combination::fixed;
    job.budget = {1u << 30, 12.5, 0.03, 1u << 20, true};
    job.sampler.seed = 123456789012345678u;
    job.farm = {17, true, 0.1, 2.25, 7.5, 3.5, "sse4.2", true};
    job.output.directory = "runs/x";
    job.output.file = "y.exr";
    const std::string text = write_job(job);
    const Job back = job_of(text);
    EXPECT_EQ(write_job(back), text);
    EXPECT_EQ(back.scene.file, job.scene.file);
    EXPECT_EQ(back.scene.defines, job.scene.defines);
    EXPECT_EQ(back.image.width, 640);
    EXPECT_EQ(back.integrator.max_depth, 12);
    EXPECT_TRUE(back.integrator.hide_emitters);
    EXPECT_EQ(back.guiding.type, GuidingType::none) << "a key must win over the preset of its layer";
    EXPECT_EQ(back.guiding.preset, "paper");
    EXPECT_EQ(back.guiding.bsdf_fraction, 0.1f);
    EXPECT_EQ(back.guiding.directional_threshold, 0.0007f);
    EXPECT_EQ(back.budget.spp, 1u << 30);
    EXPECT_EQ(back.budget.seconds, 12.5);
    EXPECT_EQ(back.budget.error, 0.03);
    EXPECT_EQ(back.budget.max_spp, 1u << 20);
    EXPECT_TRUE(back.budget.strict);
    EXPECT_EQ(back.sampler.seed, job.sampler.seed);
    EXPECT_EQ(back.farm.update_seconds, 2.25);
    EXPECT_EQ(back.output.file, "y.exr");
}

/// Found by fuzzing: toml++ wrote such texts over several lines, and lost the first newline.
TEST(Job, TextsOfSeveralLinesReadBackTheSame) {
    Job job;
    job.scene.file = "\nnot 'a' \"path\"\n";
    job.scene.defines = {{"\nodd\nname", "\n\nvalue\t\\"}, {"plain", "it's"}};
    const std::string text = write_job(job);
    const Job back = job_of(text);
    EXPECT_EQ(write_job(back), text);
    EXPECT_EQ(back.scene.file, job.scene.file);
    EXPECT_EQ(back.scene.defines, job.scene.defines);
}

TEST(Job, WritesEveryStoredKey) {
    const std::vector<Setting> written = parse_job_settings(write_job(Job{}), "job.toml");
    std::size_t stored = 0;
    for (const JobKey& key : job_keys()) {
        if (!key.stored()) continue;
        ++stored;
        const bool found =
            std::any_of(written.begin(), written.end(), [&](const Setting& s) { return s.key == key.name; });
        EXPECT_TRUE(found) << key.name;
    }
    EXPECT_EQ(written.size(), stored);
}

TEST(Job, DefaultsAreAllowedValues) {
    for (const JobKey& key : job_keys()) {
        if (!key.stored()) continue;
        Job job;
        EXPECT_TRUE(key.parse(job, key.print(Job{}))) << key.name;
        EXPECT_FALSE(key.doc.empty());
        EXPECT_NE(job_key_documentation().find("`" + key.name + "`"), std::string::npos);
    }
}

TEST(Job, PresetComesFirstInItsLayer) {
    const Job job = job_of("[guiding]\nspp_unit = 8\npreset = \"paper\"\n");
    EXPECT_EQ(job.guiding.spp_unit, 8);
    EXPECT_EQ(job.guiding.combination, Combination::last);
    EXPECT_EQ(job.integrator.next_event, NextEvent::never);
    EXPECT_EQ(job.guiding.spatial_threshold, 12000);
    EXPECT_EQ(job.guiding.preset, "paper");
}

TEST(Job, TheImprovedProgramLeavesNextEventToTheScene) {
    Job job = job_of("[guiding]\npreset = \"improved\"\n[integrator]\nnext_event = \"kickstart\"\n");
    EXPECT_EQ(job.guiding.type, GuidingType::ppg);
    EXPECT_EQ(job.guiding.spatial_threshold, 4000);
    EXPECT_EQ(job.guiding.spp_unit, 1);
    EXPECT_EQ(job.guiding.combination, Combination::inverse_variance);
    EXPECT_EQ(job.guiding.roulette, GuidingRoulette::constant);
    EXPECT_EQ(job.integrator.light_selection, LightSelection::power);
    EXPECT_EQ(job.guiding.candidates, 1);
    EXPECT_EQ(job.guiding.splitting, 1);
    EXPECT_EQ(job.integrator.mis, MisHeuristic::power);
    EXPECT_EQ(job.integrator.next_event, NextEvent::kickstart);
    EXPECT_FALSE(job.integrator.split_glass);
}

TEST(Job, LaterLayersWin) {
    Job job;
    apply_layer(job, std::vector<Setting>{{"guiding.preset", "paper", {}}, {"budget.spp", "127", {}}});
    apply_layer(job, parse_job_settings("budget.spp = 32\nguiding.combination = \"fixed\"\n", "job.toml"));
    apply_layer(job, std::vector<Setting>{parse_set_argument("budget.spp=16")});
    EXPECT_EQ(job.budget.spp, 16u);
    EXPECT_EQ(job.guiding.combination, Combination::fixed);
    EXPECT_EQ(job.integrator.next_event, NextEvent::never);
}

TEST(Job, WhoChoosesTheGuideIsNotBoundToTheScenesPreset) {
    const std::vector<Setting> scene{{"guiding.preset", "paper", {}}, {"integrator.max_depth", "10", {}}};
    const std::vector<Setting> other{{"budget.spp", "16", {}}}, chosen{parse_set_argument("guiding.type=ppg")};
    EXPECT_EQ(scene_layer(scene, {other, other}).size(), 2u);
    const std::vector<Setting> left = scene_layer(scene, {other, chosen});
    ASSERT_EQ(left.size(), 1u);
    EXPECT_EQ(left[0].key, "integrator.max_depth");
    const std::vector<Setting> preset{parse_set_argument("guiding.preset=improved")};
    EXPECT_EQ(scene_layer(scene, {other, preset}).size(), 1u) << "the scene's would leave next event off";
}

TEST(Job, SetArguments) {
    Job job;
    apply_layer(job,
                std::vector<Setting>{parse_set_argument("integrator.next_event = \"never\""),
                                     parse_set_argument("scene.defines.a=b=c"), parse_set_argument("output.file=")});
    EXPECT_EQ(job.integrator.next_event, NextEvent::never);
    EXPECT_EQ(job.scene.defines.at("a"), "b=c");
    EXPECT_EQ(job.output.file, "");
    EXPECT_THROW(parse_set_argument("budget.spp"), InputError);
    EXPECT_THROW(parse_set_argument("budget.ssp=4"), InputError);
}

TEST(Job, UnknownKeySuggestsTheNearest) {
    EXPECT_EQ(message_of("[integrator]\nmax_depht = 3\n"),
              "job.toml:2:1: unknown key \"integrator.max_depht\"; did you mean integrator.max_depth?");
    EXPECT_NE(message_of("[zzz]\nqqqqqqqqqqq = 3\n").find("job.toml:1:"), std::string::npos);
    EXPECT_EQ(message_of("budget = 3\n"),
              "job.toml:1:1: \"budget\" is no key, but a table of keys; write [budget] and keys below it");
    EXPECT_NE(message_of("[guidng]\ntype = \"none\"\n").find("did you mean guiding"), std::string::npos);
}

TEST(Job, ARenamedKeySaysItsNewName) {
    EXPECT_EQ(message_of("[guiding]\nlight_selection = \"power\"\n"),
              "job.toml:2:1: \"guiding.light_selection\" is called integrator.light_selection now; set that");
}

TEST(Job, WrongTypesAndRanges) {
    EXPECT_EQ(message_of("[budget]\nspp = \"64\"\n"),
              "job.toml:2:7: budget.spp is text, not an integer; allowed: 1 to 2^30");
    EXPECT_EQ(message_of("[budget]\nspp = 0\n"), "job.toml:2:7: budget.spp = \"0\" is not allowed; allowed: 1 to 2^30");
    for (const char* line : {"budget.spp = 1.5",
                             "budget.spp = 4294967296",
                             "budget.spp = -1",
                             "budget.spp = [1]",
                             "budget.spp = 1979-05-27",
                             "integrator.max_depth = 0",
                             "integrator.max_depth = -2",
                             "integrator.rr_depth = 0",
                             "integrator.type = \"bdpt\"",
                             "integrator.next_event = true",
                             "integrator.mis = \"\"",
                             "guiding.bsdf_fraction = 0",
                             "guiding.bsdf_fraction = nan",
                             "guiding.bsdf_fraction = 1.01",
                             "guiding.bsdf_fraction = 1e-60",
                             "guiding.directional_threshold = 0.0004",
                             "guiding.directional_threshold = inf",
                             "guiding.spatial_threshold = -1",
                             "guiding.spp_unit = 0",
                             "farm.tile_size = 0",
                             "farm.tile_size = 1025",
                             "farm.heartbeat_seconds = 0",
                             "farm.heartbeat_seconds = -inf",
                             "farm.isa = \"neon\"",
                             "image.width = 65536",
                             "image.height = -1",
                             "sampler.seed = -1",
                             "scene.lenient = 1",
                             "scene.file = 3",
                             "scene.defines = 3",
                             "scene.defines.a = [1]"})
        EXPECT_NE(message_of(line).find("job.toml:1:"), std::string::npos) << line << " -> " << message_of(line);
}

TEST(Job, WhatIsNotAvailableSaysSoAndNamesACure) {
    for (const char* line : {"guiding.spatial_filter = \"box\""}) {
        const std::string message = message_of(line);
        EXPECT_NE(message.find("is not available in this version; "), std::string::npos) << line << " -> " << message;
        EXPECT_NE(message.find("job.toml:1:"), std::string::npos) << message;
    }
}

TEST(Job, TheBsdfFractionIsANumberOrLearned) {
    Job job = job_of("guiding.bsdf_fraction = \"learned\"\n");
    EXPECT_TRUE(job.guiding.learn_bsdf_fraction);
    EXPECT_EQ(job.guiding.bsdf_fraction, 0.5f);
    job = job_of("guiding.bsdf_fraction = 0.25\n");
    EXPECT_FALSE(job.guiding.learn_bsdf_fraction);
    EXPECT_EQ(job.guiding.bsdf_fraction, 0.25f);
    job = job_of("guiding.bsdf_fraction = \"learned\"\n");
    EXPECT_TRUE(job_of(write_job(job)).guiding.learn_bsdf_fraction);
    for (const char* bad : {"0", "1.5", "\"earned\"", "true"})
        EXPECT_NE(message_of(std::string("guiding.bsdf_fraction = ") + bad), "no error") << bad;
}

TEST(Job, BrokenTomlHasALocation) {
    EXPECT_EQ(message_of("[budget]\nspp = = 3\n").substr(0, 13), "job.toml:2:7:");
    EXPECT_NE(message_of("[budget]\nspp = 3\nspp = 4\n").find("job.toml:3:"), std::string::npos);
    EXPECT_EQ(message_of("[budget]\nspp = = 3\n").find('\n'), std::string::npos);
}

/// Each dot of a key is a table within another one: so many would exhaust the stack.
TEST(Job, KeysOfVeryManyDotsAreRefused) {
    std::string dots;
    for (int i = 0; i < 100'000; ++i)
        dots += "a.";
    for (const std::string& text : {dots + "a = 1", "[" + dots + "a]\nb = 1", "x = {" + dots + "a = 1}"})
        EXPECT_NE(message_of("\n" + text).find("job.toml:2: a key of 100000 dots"), std::string::npos)
            << message_of(text).substr(0, 200);
    EXPECT_EQ(message_of("# " + dots + " = \n[output]\nfile = \"" + dots.substr(0, 2000) + "exr\"\n"), "no error");
}

TEST(Job, SceneFileIsRelativeToTheJobFile) {
    const std::filesystem::path folder = test::test_folder();
    std::ofstream(folder / "job.toml") << "scene.file = \"../scenes/a.xml\"\n";
    EXPECT_EQ(read_job_file(folder / "job.toml").scene.file,
              std::filesystem::absolute(folder.parent_path() / "scenes/a.xml").lexically_normal().string());
    EXPECT_THROW(read_job_file(folder / "none.toml"), InputError);
    EXPECT_THROW(read_job_file(folder), InputError);
}

TEST(Job, OwnJobsCanBeRead) {
    const std::filesystem::path jobs = std::filesystem::path(test::own_scene("")).parent_path().parent_path() / "jobs";
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(jobs)) {
        const Job job = read_job_file(entry.path());
        EXPECT_TRUE(std::filesystem::exists(job.scene.file)) << entry.path() << ": " << job.scene.file;
        ++count;
    }
    EXPECT_GE(count, 3u);
}

TEST(ParseText, Numbers) {
    EXPECT_EQ(parse_number(" +1.5e1 "), 15.0);
    EXPECT_EQ(parse_number("1e-400"), 0.0);
    EXPECT_EQ(parse_number(".5"), 0.5);
    for (const char* bad : {"", " ", "nan", "inf", "1e400", "0x10", "1,5", "1 2", "+-1", "--1", "1e", "one"})
        EXPECT_FALSE(parse_number(bad)) << bad;
    EXPECT_FALSE(parse_integer("99999999999999999999"));
    EXPECT_FALSE(parse_integer("1.0"));
    EXPECT_FALSE(parse_unsigned("-1"));
}

}  // namespace
}  // namespace treefarm
