// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <random>
#include <string>

#include "coordinator/checkpoint/state_codec.h"
#include "tests/fault/farm_fixture.h"

namespace treefarm::test {

/// Renders of a tiny job under random faults: workers die, stop for a while, are cut off for a while, leave, come late,
/// and the coordinator dies and resumes from its last checkpoint. Faults are timed by a worker's n-th message, not by
/// milliseconds, so that a seed reproduces most of a run.
class FaultStorm : public FarmTest {
  protected:
    /// Counts of the faults that occurred.
    struct Count {
        int deaths = 0, stops = 0, cuts = 0, leaves = 0, late = 0, crashes = 0;
        int all() const { return deaths + stops + cuts + leaves + late + crashes; }
    };

    void SetUp() override {
        job_.farm.heartbeat_seconds = 0.004;
        job_.farm.update_seconds = 0.004;
        job_.farm.leave_seconds = 0.02;
        job_.output.aovs = "albedo,direct";
    }

    /// Repeats renders until `faults` faults have occurred; each render must have the bits of the undisturbed one.
    Count storm(int faults, unsigned seed) {
        constexpr int kTold = 500;  // faults between two log lines
        int told = 0;
        const RenderResult calm = calm_render();
        while (counted_.all() < faults && !HasFailure()) {
            random_.seed(seed);
            const RenderResult result = stormy_render();
            EXPECT_EQ(hash_text(result.image_hash), hash_text(calm.image_hash)) << "seed " << seed;
            EXPECT_EQ(hash_text(result.tree_hash), hash_text(calm.tree_hash)) << "seed " << seed;
            EXPECT_EQ(hash_text(result.aov_hash), hash_text(calm.aov_hash)) << "seed " << seed;
            for (std::size_t k = 0; k < result.passes.size() && k < calm.passes.size(); ++k)
                EXPECT_EQ(result.passes[k].stats.paths, calm.passes[k].stats.paths) << "seed " << seed;
            ++seed;
            ++renders_;
            if (counted_.all() / kTold != told / kTold) {
                told = counted_.all();
                std::cout << told << " of " << faults << " faults, " << renders_ << " renders in " << lives_ << " lives"
                          << std::endl;
            }
        }
        return counted_;
    }

    int renders() const { return renders_; }
    int lives() const { return lives_; }  ///< of all renders: each crash of a coordinator begins another

  private:
    /// Time limits, `patience` times as long as a quiet machine needs.
    static FarmLimits limits(double patience) {
        return {.gather = 1, .lost = 0.04 * patience, .dismiss = 0.1, .grace = 0.3 * patience, .asking = 0.002};
    }
    static constexpr double kSilence = 0.15;

    RenderResult calm_render() {
        make_workers(1);
        const RenderResult result = render();
        faulty_.clear();
        return result;
    }

    unsigned below(unsigned limit) { return static_cast<unsigned>(random_() % limit); }

    /// One render, resumed after each crash.
    RenderResult stormy_render() {
        constexpr int kMostLives = 60;
        saved_.clear();
        for (int life = 0; life < kMostLives; ++life) {
            ++lives_;
            // On a busy machine workers may send nothing within a hundredth of a second, after each resume.
            patience_ = 1.0 + life / 4;
            threads_.clear();
            faulty_.clear();
            told_.clear();
            job_.farm.tile_size = static_cast<int>(5 + below(20));
            make_workers(static_cast<int>(1 + below(4)));
            for (std::size_t w = 0; w < faulty_.size(); ++w)
                prepare(w);
            plan_crash();
            if (!saved_.empty()) resumed_ = decode_state({1, saved_}, kWidth * kHeight, aov_requests(job_));
            if (resumed_) restore_films(*resumed_);
            try {
                RenderResult result = render(limits(patience_));
                hooks_ = {};
                return result;
            } catch (const RunError&) {  // a crash, or no worker was left
                hooks_ = {};
                resumed_.reset();
            }
        }
        ADD_FAILURE() << "it never ends";
        return {};
    }

    /// Chooses the faults of a worker until the next resume.
    void prepare(std::size_t w) {
        settings_[w].threads = 1 + below(2);
        settings_[w].silence_seconds = kSilence * patience_;
        told_.push_back(std::make_unique<std::atomic<bool>>(false));
        settings_[w].told_to_leave = [told = told_.back().get()] { return told->load(); };
        FaultyChannel* const channel = faulty_[w].get();
        const unsigned kind = below(6), at = 1 + below(60), pause = 10 + below(120);
        channel->outgoing = [=, this, sent = 0u](Bytes&) mutable {
            if (++sent == at) strike(kind, channel, static_cast<int>(pause * patience_), *told_[w]);
            return true;
        };
        const bool is_late = below(5) == 0;
        if (is_late) count(&Count::late);
        threads_.emplace_back([this, w, delay = is_late ? below(60) : 0u] {
            std::this_thread::sleep_for(std::chrono::milliseconds(delay));
            ends_[w] = run_worker(*faulty_[w], settings_[w], renderers_[w], quiet_log());
        });
    }

    void strike(unsigned kind, FaultyChannel* channel, int pause, std::atomic<bool>& told) {
        switch (kind) {
            case 0:
                channel->cut = true;
                return count(&Count::deaths);
            case 1:
            case 2:
                channel->nap_ms = pause;
                return count(&Count::stops);
            case 3:
                channel->held_ms = pause;
                return count(&Count::cuts);
            case 4:
                told = true;
                return count(&Count::leaves);
            default:
                return;  // no fault
        }
    }

    void count(int Count::*kind) {
        const std::scoped_lock lock(mutex_);
        ++(counted_.*kind);
    }

    /// Chooses the step at which the coordinator crashes; it writes checkpoints.
    void plan_crash() {
        const unsigned every = 1 + below(40), crash = below(3) == 0 ? ~0u : 5 + below(400);
        hooks_.state_due = [every, asked = 0u]() mutable { return ++asked % every == 0; };
        hooks_.on_state = [this](RenderState& state) { save(state); };
        hooks_.on_progress = [this, crash, steps = 0u](const RenderProgress&) mutable {
            if (++steps != crash) return;
            count(&Count::crashes);
            throw RunError("the coordinator dies");
        };
    }

    /// Saves a checkpoint with its films, in memory.
    void save(RenderState& state) {
        films_.clear();
        for (PassResult& film : state.films) {
            film.stored = "film-" + std::string(32, static_cast<char>('a' + films_.size() % 6)) + ".tff";
            films_.push_back(film.pixels);
        }
        CheckpointOrigin origin;
        origin.pixels = kWidth * kHeight;
        saved_ = encode_state(origin, state);
    }

    void restore_films(RenderState& state) {
        ASSERT_EQ(state.films.size(), films_.size());
        for (std::size_t k = 0; k < films_.size(); ++k)
            state.films[k].pixels = films_[k];
    }

    std::mt19937 random_;
    std::mutex mutex_;
    Count counted_;
    int renders_ = 0, lives_ = 0;
    double patience_ = 1;
    std::vector<std::unique_ptr<std::atomic<bool>>> told_;
    std::vector<Section> saved_;
    std::vector<std::vector<PixelEstimate>> films_;
};

}  // namespace treefarm::test
