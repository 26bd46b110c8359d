// SPDX-License-Identifier: Apache-2.0
#include "common/plan/resolve.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "common/config/job_keys.h"
#include "common/config/job_reader.h"
#include "common/plan/policy.h"
#include "common/plan/policy_table.h"
#include "common/plan/schedule.h"
#include "tests/support/support.h"

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
    for (const char* word : {"\"usual\"", "'usual'"})
        EXPECT_EQ(write_job(job).find(word), std::string::npos) << write_job(job);
}

/// A worker resolves what the coordinator has resolved, and so does who renders a resolved.toml.
TEST(Resolve, OfAResolvedJobItGivesTheSame) {
    for (const auto& job :
         {Job(), with({{"guiding.type", "none"}}), with({{"guiding.type", "ppg"}, {"guiding.splitting", "4"}}),
          with({{"guiding.type", "view"}, {"guiding.roulette", "constant"}}), with({{"guiding.preset", "thesis"}}),
          with({{"integrator.next_event", "never"}}), with({{"guiding.splitting_rule", "always"}})}) {
        const Resolved once = resolve(job, glossy()), twice = resolve(once, glossy());
        EXPECT_EQ(write_job(once), write_job(twice));
        EXPECT_EQ(once.guides, twice.guides);
        EXPECT_EQ(once.learns_views, twice.learns_views);
        EXPECT_EQ(once.learns_lights, twice.learns_lights);
        EXPECT_EQ(once.cells_follow_use, twice.cells_follow_use);
    }
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
        PassPlan pass = make_pass(resolved, 3, 7, 8, false);
        set_guiding(pass, resolved, Guiding::loses);
        set_splitting(pass, resolved, false);
        return pass;
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

/// Members of Policy that have a default, as the header has them: "guiding.giving_up".
std::vector<std::string> constants_of_policy_h() {
    std::ifstream header(std::string(TREEFARM_SOURCE_DIR) + "/common/plan/policy.h");
    std::vector<std::string> names, group;
    for (std::string line; std::getline(header, line);) {
        std::istringstream words(line);
        std::string first, second, third;
        words >> first >> second >> third;
        if (third == "=") group.push_back(second);
        if (first == "}" && second.ends_with(";")) {
            for (const std::string& member : group)
                names.push_back(second.substr(0, second.size() - 1) + "." + member);
            group.clear();
        }
    }
    return names;
}

TEST(PolicyTable, ExplainsEveryConstant) {
    std::vector<std::string> explained;
    for (const PolicyEntry& entry : policy_table()) {
        explained.push_back(entry.name);
        EXPECT_GT(std::string(entry.meaning).size(), 8u) << entry.name;
        EXPECT_FALSE(std::string(entry.evidence).empty()) << entry.name;
    }
    EXPECT_EQ(explained, constants_of_policy_h());
    EXPECT_GT(explained.size(), 60u);
}

std::string resolved_toml(const Job& job) {
    return write_job(resolve(job, glossy())) + "\n" + write_policy();
}

TEST(ResolvedToml, GivesTheJobBack) {
    const Job asked = with({{"budget.spp", "60"}, {"sampler.seed", "7"}});
    Job job;
    apply_layer(job, without_policy(parse_job_settings(resolved_toml(asked), "resolved.toml")));
    EXPECT_EQ(write_job(job), write_job(resolve(asked, glossy())));
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
    const struct {
        std::string text, named;
    } cases[] = {{changed("giving_up = 0.85", "giving_up = 0.8"), "guiding.giving_up was 0.8, and is 0.85"},
                 {changed("giving_up = 0.85\n", ""), "guiding.giving_up is not in it"},
                 {changed("giving_up = 0.85", "giving_up = 0.85\nlosing_all = 1"), "guiding.losing_all is no constant"},
                 {changed("rr_depth = 5\n", ""), "integrator.rr_depth is not in it"},
                 {changed("giving_up = 0.85", "giving_up = \"much\""), "is no number"}};
    for (const auto& [text, named] : cases) {
        try {
            without_policy(parse_job_settings(text, "resolved.toml"));
            ADD_FAILURE() << named;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(named), std::string::npos) << error.what();
            EXPECT_EQ(error.where().file, "resolved.toml");
        }
    }
}

TEST(ResolvedToml, AJobFileHasNoPolicy) {
    const auto settings = parse_job_settings("[budget]\nspp = 4\n", "job.toml");
    EXPECT_EQ(without_policy(settings).size(), 1u);
}

}  // namespace
}  // namespace treefarm
