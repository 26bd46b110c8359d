// SPDX-License-Identifier: Apache-2.0
#include "coordinator/checkpoint/checkpoint_store.h"

#include <gtest/gtest.h>

#include <fstream>

#include "common/base/error.h"
#include "common/config/aov_list.h"
#include "common/film/pixel_codec.h"
#include "common/plan/forecast/memory.h"
#include "common/plan/schedule/schedule.h"
#include "tests/support/refusal.h"
#include "tests/support/test_folder.h"
#include "tests/support/test_scenes.h"

namespace treefarm {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPixels = 12;

class Checkpoints : public ::testing::Test {
  protected:
    fs::path run_ = test::fresh_test_folder();
    fs::path folder_ = run_ / kCheckpointFolder;

    /// A state after so many passes, whose films hold their numbers.
    static RenderState state_of(std::size_t passes) {
        RenderState state;
        state.tree = initial_tree(Box3(Vec3(0.0f), Vec3(1.0f)), 1.0f);
        for (std::size_t k = 0; k < passes; ++k) {
            PassResult film{1, 0, std::vector<PixelEstimate>(kPixels)};
            for (PixelEstimate& pixel : film.pixels)
                pixel.add(0, Rgb(static_cast<float>(k)));
            state.films.push_back(std::move(film));
            PassFacts facts;
            facts.spp = 1;
            facts.spp_before = static_cast<std::uint32_t>(k);
            state.history.passes.push_back(facts);
            state.reports.emplace_back();
            state.reports.back().plan.spp = 1;
        }
        return state;
    }

    static void write(CheckpointStore& store, RenderState state) { store.prepare(origin(), state)(); }

    static CheckpointOrigin origin() {
        CheckpointOrigin from;
        from.build = "a build";
        from.pixels = kPixels;
        return from;
    }

    LoadedCheckpoint load() const {
        return load_checkpoint(run_, [](const CheckpointOrigin&) {});
    }

    std::string fault() const {
        return test::refusal_of([&] { load(); });
    }

    void damage(const fs::path& file) const {
        std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
        stream.seekp(static_cast<std::streamoff>(fs::file_size(file) / 2));
        stream.put('\x55').put('\xaa').put('\x55');
    }

    std::size_t films() const {
        std::size_t count = 0;
        for (const auto& entry : fs::directory_iterator(folder_))
            count += entry.path().filename().string().starts_with("film-");
        return count;
    }
};

TEST_F(Checkpoints, TheNewestIsReadWithItsFilms) {
    CheckpointStore store(run_);
    for (std::size_t k = 1; k <= 3; ++k)
        write(store, state_of(k));
    const LoadedCheckpoint loaded = load();
    EXPECT_EQ(loaded.generation, 3u);
    EXPECT_EQ(loaded.origin.build, "a build");
    EXPECT_EQ(loaded.state.spp(), 3u);
    EXPECT_TRUE(loaded.warnings.empty());
    ASSERT_EQ(loaded.state.films.size(), 3u);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_EQ(loaded.state.films[k].pixels[5].half[0].mean.x, static_cast<double>(k));
    EXPECT_EQ(films(), 3u) << "each film once";
}

TEST_F(Checkpoints, WhatDecidesOnGuidingAndNextEventIsKept) {
    CheckpointStore store(run_);
    RenderState state = state_of(2);
    auto& [guiding, verdict] = state.history.decisions.get<GuidingDecision::Memory>();
    verdict = Guiding::loses;
    GuidingEvidence evidence{.samples = 8, .guided_cost = 3, .unguided_cost = 2};
    evidence.guided.fill(0.5);
    evidence.unguided.fill(0.25);
    PassPlan pass;
    pass.spp = 8;
    EXPECT_EQ(guiding.after_guided(pass, evidence).guiding, Guiding::loses);
    pass.index = 5;
    EXPECT_EQ(guiding.after_unguided(pass, 100, Guiding::loses).guiding, Guiding::open) << "with mistrust";
    SdTree tree = *state.tree.get_if<SdTree>();
    tree.next_event.assign(tree.leaf_count(), 2);
    tree.image = {1, {0.5f}, 1};
    state.tree = tree;
    // Half of what was learned before the checkpoint counts after it: twins that learn on agree.
    const NextEventSums sums = {4000, 4000, 4000, 100 << 16, 110 << 16, 150 << 16, 0};
    const NextEventPrice price{1.0, 8.0, 1000};
    std::uint8_t code = 0;
    auto& next_event = state.history.decisions.get<NextEventDecision::Memory>();
    next_event.learner.learn(sums, price, code);
    next_event.code = 1;
    state.history.decisions.get<SplittingDecision::Memory>().pays = false;
    state.history.decisions.get<LightSubpathDecision::Memory>() = {false, {1, 2, 3, 4, 5, 6}, {.rays = 7}};
    state.history.decisions.get<EmissionSums>() = {{1, 2}, {3, 4}};
    state.reports.back().decisions.get<GuidingVerdict>().efficiency = {
        .efficiency = 0.5, .error = 0.25, .unguided_variance = 2};
    state.reports.back().decisions.get<NextEventDecision::Figures>().verdict = {0.5, 0.25};
    state.reports.back().decisions.get<NextEventDecision::Figures>().samples = 0.75;
    state.reports.back().stats.tails.add({2.5f, 1, 3, 4, 5, {LightFound::sampled, PathClass::glossy, 3}});
    write(store, state);
    RenderState back = load().state;
    const Decisions::Memories& kept = back.history.decisions;
    EXPECT_EQ(kept.get<GuidingDecision::Memory>().verdict, Guiding::loses);
    EXPECT_EQ(kept.get<GuidingDecision::Memory>().passes, guiding);
    EXPECT_NE(kept.get<GuidingDecision::Memory>().passes, GuidingMemory());
    EXPECT_EQ(kept.get<NextEventDecision::Memory>().code, 1);
    EXPECT_FALSE(kept.get<SplittingDecision::Memory>().pays);
    EXPECT_FALSE(kept.get<LightSubpathDecision::Memory>().pays);
    EXPECT_EQ(kept.get<LightSubpathDecision::Memory>().sums, (LightSubpathSums{1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(kept.get<LightSubpathDecision::Memory>().counts.rays, 7u);
    EXPECT_EQ(kept.get<EmissionSums>().squares, (std::vector<std::uint64_t>{3, 4}));
    EXPECT_EQ(back.tree.encode(), state.tree.encode());
    EXPECT_EQ(back.reports.back().decisions.get<GuidingVerdict>().efficiency.error, 0.25);
    EXPECT_EQ(back.reports.back().decisions.get<NextEventDecision::Figures>().verdict.low, 0.25);
    EXPECT_EQ(back.reports.back().decisions.get<NextEventDecision::Figures>().samples, 0.75);
    EXPECT_EQ(back.reports.back().stats.tails, state.reports.back().stats.tails);
    const NextEventSums later = {4000, 4000, 4000, 50 << 16, 90 << 16, 400 << 16, 0};
    std::uint8_t here = code, there = code;
    const NextEventVerdict one = next_event.learner.learn(later, price, here),
                           other = back.history.decisions.get<NextEventDecision::Memory>().learner.learn(later, price,
                                                                                                         there);
    EXPECT_EQ(here, there);
    EXPECT_EQ(one.saved, other.saved);
    EXPECT_NE(one.saved, ImageNextEventLearner().learn(later, price, code).saved) << "or nothing was remembered";
}

TEST_F(Checkpoints, OfADirectoryWithoutAJobAreNothingToGoOnFrom) {
    CheckpointStore store(run_);
    EXPECT_FALSE(can_go_on(run_));
    write(store, state_of(1));
    EXPECT_FALSE(can_go_on(run_)) << "the directory was removed, and the render wrote a checkpoint after that";
    test::write_file(run_ / kJobFile, "");
    EXPECT_TRUE(can_go_on(run_));
}

TEST_F(Checkpoints, WhereTheNewestIsDamagedTheOneBeforeIsTaken) {
    CheckpointStore store(run_);
    for (std::size_t k = 1; k <= 3; ++k)
        write(store, state_of(k));
    damage(folder_ / "a.tfc");  // generation 3
    const LoadedCheckpoint loaded = load();
    EXPECT_EQ(loaded.generation, 2u);
    EXPECT_EQ(loaded.state.spp(), 2u);
    ASSERT_EQ(loaded.warnings.size(), 1u);
    EXPECT_NE(loaded.warnings[0].find("a.tfc is damaged in its section "), std::string::npos) << loaded.warnings[0];
    EXPECT_NE(loaded.warnings[0].find("going on from b.tfc: 2 spp"), std::string::npos) << loaded.warnings[0];

    CheckpointStore after(run_, &loaded);
    write(after, state_of(4));
    EXPECT_EQ(load().state.spp(), 4u) << "it takes the damaged one's place";
    EXPECT_TRUE(load().warnings.empty());
}

TEST_F(Checkpoints, OneWhoseFilmIsDamagedOrMissingIsNotTaken) {
    for (const bool missing : {false, true}) {
        CheckpointStore store(run_);
        write(store, state_of(1));
        write(store, state_of(2));
        const std::string newest = load().state.films[1].stored;
        if (missing)
            fs::remove(folder_ / newest);
        else
            damage(folder_ / newest);
        EXPECT_EQ(load().state.spp(), 1u);
        EXPECT_NE(load().warnings.at(0).find(missing ? "is missing" : "is damaged"), std::string::npos);
        store.remove();
        EXPECT_FALSE(fs::exists(folder_));
    }
}

TEST_F(Checkpoints, WhereBothAreUnusableBothReasonsAreTold) {
    EXPECT_NE(fault().find("no usable checkpoint (a.tfc is missing; b.tfc is missing)"), std::string::npos) << fault();
    CheckpointStore store(run_);
    write(store, state_of(1));
    write(store, state_of(2));
    damage(folder_ / "a.tfc");
    fs::resize_file(folder_ / "b.tfc", 40);
    const std::string told = fault();
    EXPECT_NE(told.find("a.tfc is damaged"), std::string::npos) << told;
    EXPECT_NE(told.find("b.tfc is cut off"), std::string::npos) << told;
    EXPECT_NE(told.find("treefarm render " + (run_ / "job.toml").string()), std::string::npos) << told;
}

TEST_F(Checkpoints, ARefusalIsNoDamage) {
    CheckpointStore store(run_);
    write(store, state_of(1));
    EXPECT_THROW(load_checkpoint(run_,
                                 [](const CheckpointOrigin&) {
                                     throw InputError({"x", 0, 0}, "other", "y");
                                 }),
                 InputError);
}

TEST_F(Checkpoints, FilmsThatNobodyNamesLeave) {
    CheckpointStore store(run_);
    write(store, state_of(3));
    RenderState folded = state_of(1);
    folded.films[0].pixels[0].add(1, Rgb(9.0f));
    write(store, folded);
    EXPECT_EQ(films(), 4u) << "the older generation still names its three";
    std::ofstream(folder_ / "a.tfc.tmp-abcdefghijkl") << "left by a killed program";
    std::ofstream(folder_ / "notes.txt") << "somebody's";
    write(store, folded);
    EXPECT_EQ(films(), 1u);
    EXPECT_FALSE(fs::exists(folder_ / "a.tfc.tmp-abcdefghijkl"));
    EXPECT_TRUE(fs::exists(folder_ / "notes.txt"));
}

TEST_F(Checkpoints, OneThatWasSupersededBeforeItWasWrittenLosesNothing) {
    CheckpointStore store(run_);
    RenderState one = state_of(1), two = state_of(2);
    const auto first = store.prepare(origin(), one);
    two.films[0].stored = one.films[0].stored;
    const auto second = store.prepare(origin(), two);
    second();
    EXPECT_EQ(load().state.spp(), 2u);
    RenderState three = state_of(3);
    const auto third = store.prepare(origin(), three);
    first();  // as the writer may, which tries again what failed
    third();
    EXPECT_EQ(load().state.spp(), 3u);
}

/// The films of a resumed render's last passes are often prepared and not yet written when the render ends.
TEST_F(Checkpoints, ADamagedFileIsNoFilmThatWasPrepared) {
    for (const bool writes_at_once : {true, false}) {
        RenderState state = state_of(2);
        const std::string name = film_name(encode_pixels(state.films[1].pixels));
        fs::create_directories(folder_);
        std::ofstream(folder_ / name) << "damaged";
        CheckpointStore store(run_);
        store.prepare(origin(), state);
        if (writes_at_once)
            store.write(origin(), state);
        else
            store.prepare(origin(), state)();
        EXPECT_EQ(load().state.spp(), 2u);
        EXPECT_TRUE(load().warnings.empty());
        store.remove();
    }
}

TEST_F(Checkpoints, AFolderThatVanishedIsMadeAgain) {
    CheckpointStore store(run_);
    RenderState state = state_of(2);
    store.prepare(origin(), state)();
    fs::remove_all(folder_);
    store.prepare(origin(), state)();
    EXPECT_EQ(load().state.spp(), 2u);
}

TEST_F(Checkpoints, AStateThatNoRenderHasIsRefused) {
    const auto fault_with = [&](const std::function<void(RenderState&)>& change) {
        CheckpointStore store(run_);
        RenderState state = state_of(2);
        change(state);
        write(store, std::move(state));
        const std::string told = fault();
        store.remove();
        return told;
    };
    EXPECT_EQ(fault_with([](RenderState&) {}), "");
    EXPECT_NE(fault_with([](RenderState& s) { s.reports.pop_back(); }).find("not a report for each pass"),
              std::string::npos);
    EXPECT_NE(fault_with([](RenderState& s) { s.films.clear(); }).find("no film"), std::string::npos);
    EXPECT_NE(fault_with([](RenderState& s) { s.films[0].pixels.pop_back(); }).find("not those of 12 pixels"),
              std::string::npos);
    EXPECT_NE(fault_with([](RenderState& s) {
                  s.history.decisions.get<GuidingDecision::Memory>().verdict = Guiding(7);
              }).find("unknown verdict"),
              std::string::npos);
    EXPECT_NE(fault_with([](RenderState& s) {
                  s.reports[1].decisions.get<GuidingVerdict>().guiding = Guiding(7);
              }).find("unknown verdict"),
              std::string::npos);
    EXPECT_NE(fault_with([](RenderState& s) {
                  s.history.decisions.get<NextEventDecision::Memory>().code = 3;
              }).find("unknown number of light samples"),
              std::string::npos);
    EXPECT_NE(fault_with([](RenderState& s) {
                  s.history.decisions.get<EmissionSums>().paths.push_back(1);
              }).find("light paths without their splats"),
              std::string::npos);
    EXPECT_NE(fault_with([](RenderState& s) { s.reports[0].plan.spp = 0; }).find("impossible report of a pass"),
              std::string::npos);
    EXPECT_NE(fault_with([](RenderState& s) {
                  s.aovs = AovSums(std::vector<AovRequest>{{Aov::depth, "depth"}}, kPixels);
              }).find("AOVs of another image"),
              std::string::npos);
}

/// What a checkpoint with layers takes in memory, as `treefarm plan` says it, and no more.
TEST_F(Checkpoints, TakeTheMemoryThatIsPlanned) {
    const Scene scene = test::cornell_box(1.0f, Vec3(0.0f));
    const std::uint64_t pixels = scene.film.pixel_count();
    const auto planned = [&](const Job& job) {
        for (const MemoryItem& item : expected_memory(scene, resolve(job, scene)).coordinator)
            if (item.name == "checkpoint") return item.bytes;
        return std::uint64_t{0};
    };
    RenderState state = state_of(1);
    state.films[0].pixels.resize(pixels);
    for (const std::string aovs : {"depth", "normal,shape", "direct", "indirect,uv",
                                   "albedo,normal,geometric_normal,depth,distance,position,uv,shape,material,alpha,"
                                   "direct,indirect,spp"}) {
        Job job;
        job.output.aovs = aovs;
        state.aovs = AovSums(aov_requests(job), pixels);
        for (const Section& section : encode_state(origin(), state))
            if (section.tag == section_tag("AOVS")) {
                const double bytes = static_cast<double>(planned(job) - planned({})) / 2;
                EXPECT_NEAR(static_cast<double>(section.bytes.size()), bytes, 32.0) << aovs;
            }
    }
    EXPECT_EQ(planned({}), plan_passes(resolve(Job{}, scene)).size() * pixels * kEstimateBytes) << "all films";
}

}  // namespace
}  // namespace treefarm
