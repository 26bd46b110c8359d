// SPDX-License-Identifier: Apache-2.0
#include "common/plan/resolve/resolve.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "common/config/job_keys.h"
#include "common/config/job_reader.h"
#include "common/plan/resolve/policy_table.h"
#include "common/plan/resolve/resolved_file.h"
#include "common/plan/schedule/schedule.h"
#include "tests/support/losing_pass.h"
#include "tests/support/refusal.h"

namespace treefarm {
namespace {

SceneFacts glossy() {
    SceneFacts facts;
    facts.whole_width = facts.whole_height = 64;
    facts.film_pixels = 64 * 64;
    facts.view_dependent = facts.chooses_lights = true;
    return facts;
}

Job with(const std::vector<std::pair<std::string, std::string>>& settings) {
    Job job;
    for (const auto& [key, value] : settings)
        apply_setting(job, key, value, {});
    return job;
}

TEST(Resolve, NothingIsLeftToTheProgram) {
    const Resolved job = resolve(Job(), glossy());
    EXPECT_EQ(job.guiding.type, GuidingType::view);
    EXPECT_EQ(job.guiding.rule, Rule::while_it_pays);
    EXPECT_EQ(job.guiding.splitting, 8);
    EXPECT_EQ(job.guiding.splitting_rule, Rule::while_it_pays);
    EXPECT_EQ(job.integrator.light_selection, LightSelection::learned);
    EXPECT_NEAR(job.guiding.spatial_threshold, 2000 / std::sqrt(8.0), 1e-9);
    EXPECT_EQ(job.image.width, 64);
    EXPECT_TRUE(job.guides && job.learns_views && job.learns_lights && job.cells_follow_use);
    EXPECT_EQ(job.integrator.next_event, NextEvent::while_it_pays);
    EXPECT_EQ(job.output.compression, "rle");
    for (const char* word : {"\"usual\"", "'usual'", "\"auto\"", "'auto'"})
        EXPECT_EQ(write_job(job).find(word), std::string::npos) << write_job(job);
}

/// A worker resolves what the coordinator has resolved, and so does who renders a resolved.toml.
TEST(Resolve, OfAResolvedJobItGivesTheSame) {
    for (const auto& job :
         {Job(), with({{"guiding.type", "none"}}), with({{"guiding.type", "ppg"}, {"guiding.splitting", "4"}}),
          with({{"guiding.type", "view"}, {"guiding.roulette", "constant"}}), with({{"guiding.preset", "thesis"}}),
          with({{"integrator.next_event", "never"}}), with({{"integrator.next_event", "while_it_pays"}}),
          with({{"output.half", "true"}, {"integrator.light_samples", "0.5"}}),
          with({{"guiding.splitting_rule", "always"}})}) {
        const Resolved once = resolve(job, glossy()), twice = resolve(once, glossy());
        EXPECT_EQ(write_job(once), write_job(twice));
        EXPECT_EQ(once.guides, twice.guides);
        EXPECT_EQ(once.learns_views, twice.learns_views);
        EXPECT_EQ(once.learns_lights, twice.learns_lights);
        EXPECT_EQ(once.cells_follow_use, twice.cells_follow_use);
    }
}

TEST(Resolve, NextEventIsDecidedByPassesOrAlways) {
    const auto of = [](const char* word, const char* preset) {
        return resolve(with({{"guiding.preset", preset}, {"integrator.next_event", word}}), glossy());
    };
    for (const char* word : {"auto", "while_it_pays"}) {
        EXPECT_EQ(of(word, "").integrator.next_event, NextEvent::while_it_pays);
        EXPECT_TRUE(of(word, "").decides_next_event);
        EXPECT_EQ(of(word, "thesis").integrator.next_event, NextEvent::always);
        EXPECT_FALSE(of(word, "thesis").decides_next_event);
    }
}

TEST(Resolve, WhatAnImageIsPackedByIsWhatItsChannelsAskFor) {
    EXPECT_EQ(resolve(with({{"output.half", "true"}}), glossy()).output.compression, "zip");
    EXPECT_EQ(resolve(with({{"output.half", "true"}, {"output.compression", "piz"}}), glossy()).output.compression,
              "piz");
}

TEST(Resolve, WhatASceneDoesNotCallForIsNotLearned) {
    SceneFacts facts = glossy();
    facts.view_dependent = facts.chooses_lights = false;
    const Resolved job = resolve(Job(), facts);
    EXPECT_FALSE(job.learns_views || job.learns_lights);
    EXPECT_FALSE(resolve(with({{"integrator.next_event", "never"}}), glossy()).learns_lights);
    EXPECT_FALSE(resolve(with({{"integrator.light_selection", "tree"}}), glossy()).learns_lights);
    EXPECT_TRUE(resolve(with({{"guiding.type", "ppg"}}), glossy()).learns_lights);
    EXPECT_FALSE(resolve(with({{"guiding.preset", "paper"}}), glossy()).learns_lights);
    EXPECT_EQ(resolve(with({{"guiding.type", "none"}}), glossy()).integrator.light_selection, LightSelection::tree);
    EXPECT_EQ(resolve(with({{"guiding.preset", "thesis"}}), glossy()).integrator.light_selection,
              LightSelection::power);
    EXPECT_FALSE(resolve(with({{"guiding.type", "none"}}), glossy()).guides);
}

TEST(Resolve, ARuleSaysWhenGuidingAndSplittingMayEnd) {
    const auto pass_of = [](const Job& job) {
        const Resolved resolved = resolve(job, glossy());
        return test::after_losing_pass(resolved, make_pass(resolved, 3, 7, 8, false));
    };
    EXPECT_FALSE(pass_of(Job()).guided);
    EXPECT_TRUE(pass_of(with({{"guiding.rule", "always"}})).guided);
    EXPECT_TRUE(pass_of(with({{"guiding.type", "ppg"}})).guided);
    EXPECT_FALSE(pass_of(with({{"guiding.type", "ppg"}, {"guiding.rule", "while_it_pays"}})).guided);
    EXPECT_FALSE(pass_of(Job()).split);
    EXPECT_TRUE(pass_of(with({{"guiding.splitting", "8"}})).split);
    EXPECT_TRUE(pass_of(with({{"guiding.splitting_rule", "always"}})).split);
    EXPECT_FALSE(pass_of(with({{"guiding.splitting", "4"}, {"guiding.splitting_rule", "while_it_pays"}})).split);
}

TEST(Policy, EveryConstantIsExplained) {
    for (const policy::Constant& constant : tuned_constants()) {
        EXPECT_GT(std::string(constant.meaning).size(), 8u) << constant.name;
        EXPECT_FALSE(std::string(constant.evidence).empty()) << constant.name;
    }
    EXPECT_GT(tuned_constants().size(), 60u);
}

TEST(Policy, EveryConstantIsReadWhereItDecides) {
    namespace fs = std::filesystem;
    std::string sources;
    for (const char* folder : {"common", "coordinator", "worker", "report", "serve", "cli"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(TREEFARM_SOURCE_DIR) / folder))
            if (entry.path().extension() == ".h" || entry.path().extension() == ".cpp")
                sources += (std::stringstream() << std::ifstream(entry.path()).rdbuf()).str();
    for (const policy::Constant& constant : tuned_constants())
        EXPECT_TRUE(sources.find("(\"" + std::string(constant.name) + "\")") != std::string::npos)
            << constant.name << " decides nothing";
}

constexpr char kHash[] = "0123456789abcdef";

std::string resolved_toml(const Job& job) {
    return write_resolved(resolve(job, glossy()), {"1.2.3", kHash});
}

TEST(ResolvedToml, GivesTheJobBack) {
    const Job asked = with({{"budget.spp", "60"}, {"sampler.seed", "7"}});
    EXPECT_EQ(write_job(read_resolved(resolved_toml(asked), "resolved.toml")), write_job(resolve(asked, glossy())));
}

TEST(ResolvedToml, TellsOfWhichRenderItIs) {
    const auto experiment = [](const std::string& text) {
        return checked_job_file(parse_job_settings(text, "resolved.toml")).experiment.value();
    };
    const Experiment plain = experiment(resolved_toml(Job()));
    EXPECT_EQ(plain.version, "1.2.3");
    EXPECT_EQ(plain.scene_hash, kHash);
    EXPECT_EQ(plain.schedule, "");
    EXPECT_EQ(plain.where.file, "resolved.toml");
    EXPECT_EQ(plain.where.line, 6);
    EXPECT_EQ(experiment(write_resolved(resolve(Job(), glossy()), {"1.2.3", kHash, "schedule.toml"})).schedule,
              "schedule.toml");
}

std::string cut(std::string text, const std::string& from, const std::string& to = "") {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.erase(at, to.empty() ? std::string::npos : text.find(to, at) - at);
}

TEST(ResolvedToml, ConstantsThatAreNoLongerRecordedMayStandInIt) {
    std::string text = resolved_toml(Job());
    text.insert(text.find("[policy.levels]\n") + 16, "block = 8\n");
    text += "\n[policy.farm]\nhalf_life = 2\n\n[policy.splats]\nnearest = 1.52587890625e-05\n";
    EXPECT_NO_THROW(checked_job_file(parse_job_settings(text, "resolved.toml")));
}

TEST(ResolvedToml, OfAnotherBuildIsRefusedByName) {
    const std::string toml = resolved_toml(Job());
    const auto changed = [&](const std::string& from, const std::string& to) {
        std::string text = toml;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        text.replace(at, from.size(), to);
        return text;
    };
    const std::string results = "results = " + std::to_string(kResults);
    const struct {
        std::string text, named;
    } cases[] = {
        {changed("giving_up = 0.85", "giving_up = 0.8"), "guiding.giving_up was 0.8, and is 0.85"},
        {changed("giving_up = 0.85\n", ""), "guiding.giving_up is not in it"},
        {changed("giving_up = 0.85", "giving_up = 0.85\nlosing_all = 1"), "guiding.losing_all is no constant"},
        {changed("rr_depth = 5\n", ""), "integrator.rr_depth is not in it"},
        {changed("giving_up = 0.85", "giving_up = \"much\""), "guiding.giving_up was much"},
        {changed("[policy.levels]\n", "[policy.levels]\nblock = 16\n"), "levels.block was 16, and is 8"},
        {cut(toml, "[policy."), "policy.guiding.least_judged_spp is not in it"},
        {cut(toml, "[experiment]", "[scene]"), "experiment.version is not in it"},
        {changed(results, ""), "experiment.results is not in it"},
        {changed(results, "results = 1000"), "experiment.results was 1000, and is " + std::to_string(kResults)},
        {changed(results, results + "\nodd = 1"), "experiment.odd is nothing that this build knows"}};
    for (const auto& [text, named] : cases) {
        try {
            checked_job_file(parse_job_settings(text, "resolved.toml"));
            ADD_FAILURE() << named;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
            EXPECT_NE(std::string(error.what()).find("render job.toml instead"), std::string::npos) << error.what();
            EXPECT_EQ(error.where().file, "resolved.toml");
        }
    }
}

TEST(ResolvedToml, OfAnotherSceneIsRefused) {
    const Experiment experiment{"1.2.3", kHash, "", {"resolved.toml", 6, 1}};
    EXPECT_NO_THROW(require_scene(experiment, kHash, "1.2.3", ""));
    EXPECT_NO_THROW(require_scene(experiment, kHash, "1.3.0", "-D width"));
    const auto refusal = [&](const std::string& version, const std::string& changed_by) -> std::string {
        return test::refusal_of([&] { require_scene(experiment, "fedcba9876543210", version, changed_by); });
    };
    EXPECT_EQ(refusal("1.2.3", "")
                  .find("resolved.toml:6:1: experiment.scene_hash was 0123456789abcdef, and is "
                        "fedcba9876543210 now: the scene has changed since; render job.toml"),
              0u)
        << refusal("1.2.3", "");
    EXPECT_NE(refusal("1.2.3", "-D width").find("or -D width makes another of it"), std::string::npos);
    EXPECT_NE(refusal("1.3.0", "").find("or version 1.2.3 read it otherwise than 1.3.0"), std::string::npos);
}

TEST(ResolvedToml, AJobFileIsNone) {
    const JobFile file = checked_job_file(parse_job_settings("[budget]\nspp = 4\n", "job.toml"));
    EXPECT_EQ(file.settings.size(), 1u);
    EXPECT_FALSE(file.experiment);
}

}  // namespace
}  // namespace treefarm
