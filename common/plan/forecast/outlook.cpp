// SPDX-License-Identifier: Apache-2.0
#include "common/plan/forecast/outlook.h"

#include <algorithm>
#include <cmath>

#include "common/base/policy.h"

namespace treefarm {
namespace {

/// Seconds of a sample if the clock did not advance.
constexpr double kShortestSample = 1e-9;
/// Relative difference in threads up to which a farm counts as equally fast.
constexpr double kOtherThreads = 0.1;

/// Passes that had one tree.
struct TreeForecast {
    double spp = 0;
    double samples_times_variance = 0, samples_times_trimmed = 0, known_spp = 0;
    double trace_core_seconds = 0;  ///< without the log of records
    bool first = false;             ///< the tree before anything was learned
    bool next_event = false;

    double variance() const { return samples_times_variance / known_spp; }
    double trimmed() const { return samples_times_trimmed / known_spp; }
    double core_per_spp() const { return trace_core_seconds / spp; }
};

std::vector<TreeForecast> trees_of(const RenderHistory& state) {
    std::vector<TreeForecast> trees;
    bool fresh = true;
    for (const PassFacts& pass : state.passes) {
        if (fresh) {
            trees.emplace_back();
            trees.back().first = trees.size() == 1;
        }
        TreeForecast& tree = trees.back();
        tree.spp += pass.spp;
        tree.next_event = pass.next_event;
        if (pass.spp >= 2) {
            tree.known_spp += pass.spp;
            tree.samples_times_variance += pass.spp * pass.mse_of_sample;
            tree.samples_times_trimmed += pass.spp * pass.stuv_trimmed;
        }
        tree.trace_core_seconds +=
            pass.trace_core_seconds * (pass.record ? 1 - tuned("forecast.recording_share") : 1.0);
        fresh = pass.record;
    }
    return trees;
}

double core_seconds(const PassFacts& pass) {
    return pass.trace_core_seconds + pass.record_core_seconds;
}

/// Wall-clock seconds per core-second of the next pass, which depends on the machine and other load. Mean over the
/// passes with about as many threads, dominated by the last and longest; if there are none, as after a resume on
/// another farm, mean over all passes, scaled by threads.
double clock_per_core(const RenderHistory& state) {
    const double threads = state.threads;
    const bool known =
        threads > 0 && std::ranges::all_of(state.passes, [](const PassFacts& p) { return p.threads > 0; });
    double clock = 0, core = 0, thread_seconds = 0, all_core = 0;
    for (const PassFacts& pass : state.passes) {
        thread_seconds += pass.threads * pass.collect_seconds;
        all_core += core_seconds(pass);
        if (known && std::abs(pass.threads - threads) > kOtherThreads * threads) continue;
        clock += pass.collect_seconds;
        core += core_seconds(pass);
    }
    return core > 0 ? clock / core : thread_seconds / all_core / threads;
}

}  // namespace

std::uint32_t RenderHistory::spp_of_last_tree() const {
    std::uint32_t spp = 0;
    for (auto pass = passes.rbegin(); pass != passes.rend(); ++pass) {
        if (pass != passes.rbegin() && pass->record) break;
        spp += pass->spp;
    }
    return spp;
}

Outlook::Outlook(const RenderHistory& state) : learning_(state.passes.back().record) {
    look_at_variance(state);
    look_at_cost(state);
}

void Outlook::look_at_variance(const RenderHistory& state) {
    struct Level {
        double weight, variance;
        int trees;
    };
    std::vector<TreeForecast> trees = trees_of(state);
    const bool several = trees.size() > 1, next_event = trees.back().next_event;
    std::erase_if(trees, [&](const TreeForecast& tree) {
        return tree.known_spp == 0 || (tree.first && several) || tree.next_event != next_event;
    });
    const bool trimmed = std::ranges::all_of(trees, [](const TreeForecast& tree) { return tree.trimmed() > 0; });
    double whole = 0, looked_at = 0;
    std::vector<Level> levels;
    for (const TreeForecast& tree : trees) {
        levels.push_back({tree.known_spp, trimmed ? tree.trimmed() : tree.variance(), 1});
        whole += tree.known_spp * tree.variance();
        looked_at += tree.known_spp * levels.back().variance;
        // More noise than with the previous tree: both count as equally good, and the difference as error of
        // measurement (isotonic regression by pooling adjacent violators).
        while (levels.size() > 1 && levels.back().variance >= levels[levels.size() - 2].variance) {
            const Level last = levels.back();
            levels.pop_back();
            Level& before = levels.back();
            before.variance =
                (before.variance * before.weight + last.variance * last.weight) / (before.weight + last.weight);
            before.weight += last.weight;
            before.trees += last.trees;
        }
    }
    // The worst pixels are assumed to add the same for all trees.
    for (Level& level : levels)
        if (looked_at > 0) level.variance *= whole / looked_at;
    if (levels.empty()) return;
    variance_ = levels.back().variance;
    quiet_ = !(variance_ > 0);
    const bool at_rest = levels.back().trees >= tuned<int>("forecast.trees_at_rest");
    if (!at_rest && levels.size() > 1)
        progress_ = std::max(tuned("forecast.least_progress"), variance_ / levels[levels.size() - 2].variance);
    else if (at_rest || levels.back().trees > 1)
        progress_ = 1;
    trees_since_ = levels.back().trees - 1;
    int back = 0;
    for (auto level = levels.rbegin(); level != levels.rend() && recent_progress_ == 0; ++level)
        if ((back += level->trees) >= 3) recent_progress_ = quiet_ ? 1.0 : variance_ / level->variance;
}

void Outlook::look_at_cost(const RenderHistory& state) {
    double clock = 0, core = 0, spp = 0;
    for (const PassFacts& pass : state.passes) {
        clock += pass.collect_seconds;
        core += core_seconds(pass);
        spp += pass.spp;
    }
    const PassFacts& last = state.passes.back();
    overhead_ = last.overhead_seconds;
    const std::vector<TreeForecast> trees = trees_of(state);
    const double traced = trees.back().core_per_spp();
    if (!(core > 0 && traced > 0)) {  // a farm that does not report its threads' work
        core_per_spp_ = clock / spp;
        return;
    }
    clock_per_core_ = clock_per_core(state);
    core_per_spp_ = traced;
    if (last.record) recording_ = core_seconds(last) / (last.spp * traced);
    if (trees.size() < 3) return;
    const TreeForecast& before = trees[trees.size() - 2];
    if (before.core_per_spp() > 0 && before.next_event == trees.back().next_event)
        cost_ratio_ = std::clamp(traced / before.core_per_spp(), 1 / tuned("forecast.most_cost_ratio"),
                                 tuned("forecast.most_cost_ratio"));
}

namespace {

/// Product of `trees` steps after a step of this size, each the previous one to the power `fading`.
double fading_steps(double step, double fading, int trees) {
    const double power = fading * (1 - std::pow(fading, trees)) / (1 - fading);
    return std::pow(step, power);
}

}  // namespace

double Outlook::variance_after(int trees) const {
    if (!(progress_ > 0)) return variance_;
    return variance_ * fading_steps(std::pow(progress_, std::pow(tuned("forecast.fading"), trees_since_)),
                                    tuned("forecast.fading"), trees);
}

double Outlook::seconds_per_spp(int trees, bool record) const {
    const double core =
        core_per_spp_ * fading_steps(cost_ratio_, tuned("forecast.cost_fading"), trees) * (record ? recording_ : 1.0);
    return std::max(core * clock_per_core_, kShortestSample);
}

}  // namespace treefarm
