// SPDX-License-Identifier: Apache-2.0
#include "common/plan/forecast/budget.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/policy.h"

namespace treefarm {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();
// Shares of the tolerance.
constexpr double kLeastLeft = 0.25;    ///< no pass begins where less time is left
constexpr double kWorthHedging = 0.5;  ///< an ending pass takes all the time left where hedging would leave less
constexpr double kMostLate = 0.75;     ///< by less than this, and than the time left, the shortest pass may end late

class OpenBudget {
  public:
    OpenBudget(const Resolved& job, const RenderHistory& state) : job_(job), memory_(state.budget) {
        if (!state.passes.empty()) outlook_.emplace(state);
    }

    NextPass next(const RenderHistory& state) {
        NextPass next = choose(state);
        next.memory = memory_;
        return next;
    }

  private:
    NextPass choose(const RenderHistory& state) {
        if (state.passes.empty()) return {first_pass(), 0, 0};
        if (memory_.ending && job_.budget.strict) return {};
        const auto index = static_cast<std::uint32_t>(state.passes.size());
        const std::uint32_t done = state.spp();
        const double others = std::min(by_error(state), static_cast<double>(job_.budget.max_spp) - done);
        const double wanted = std::min(others, by_time(state, 1.0));
        if (wanted < least_spp()) return {};
        const double doubled = std::ldexp(job_.guiding.spp_unit, static_cast<int>(index));
        const auto total = static_cast<std::uint32_t>(done + wanted);
        if (!memory_.ending && !memory_.probed && wanted >= tuned("schedule.teaching_share") * doubled)
            return {make_pass(job_, index, done, static_cast<std::uint32_t>(doubled), false), total, 0};
        if (needs_probe(state)) {
            memory_.probed = true;
            const auto spp = static_cast<std::uint32_t>(std::max(1.0, tuned("budget.probe") * by_time(state, 1.0)));
            return {make_pass(job_, index, done, spp, true), total, 0};
        }
        const double hedged = std::min(others, by_time(state, hedge(state)));
        memory_.ending = true;
        const auto spp = static_cast<std::uint32_t>(std::max(hedged, least_spp()));
        return {make_pass(job_, index, done, spp, true), total, 0};
    }

    PassPlan first_pass() const {
        const auto unit = static_cast<std::uint32_t>(job_.guiding.spp_unit);
        return make_pass(job_, 0, 0, std::min(unit, job_.budget.max_spp), unit >= job_.budget.max_spp);
    }

    /// Least samples per pixel of a pass: fewer samples of a new tree would not count in the image.
    double least_spp() const {
        const bool by_variance =
            job_.guides && job_.guiding.combination == Combination::inverse_variance && !job_.budget.strict;
        return by_variance ? tuned<std::uint32_t>("schedule.least_weighed_spp") : 1.0;
    }

    double tolerance() const {
        const double seconds = job_.budget.seconds;
        return std::max(tuned("budget.time_tolerance") * seconds,
                        std::min(tuned("budget.least_tolerance"), tuned("budget.most_tolerance") * seconds));
    }

    /// Expected seconds of an ending pass of so many samples per pixel.
    double seconds_of_pass(double spp) const {
        const int trees = outlook_->learning() ? 1 : 0;
        return outlook_->overhead_seconds() + spp * outlook_->seconds_per_spp(trees, false);
    }

    /// Whether a strict render by time has a last tree that no pass has tried, and time to try it.
    bool needs_probe(const RenderHistory& state) const {
        const double left = job_.budget.seconds - state.seconds;
        return job_.budget.strict && job_.budget.seconds > 0 && !memory_.probed && outlook_->learning() &&
               seconds_of_pass(1) < 2 * tuned("budget.probe") * left;
    }

    double hedge(const RenderHistory& state) const {
        const double uncertain = (1 - tuned("budget.hedge")) * (job_.budget.seconds - state.seconds);
        const double worthwhile = std::max(kWorthHedging * tolerance(), seconds_of_pass(2 * least_spp()));
        return job_.budget.strict || uncertain < worthwhile ? 1.0 : tuned("budget.hedge");
    }

    /// Samples of a pass that takes this share of the time left.
    double by_time(const RenderHistory& state, double fraction) const {
        if (job_.budget.seconds == 0) return kUnlimited;
        const double left = job_.budget.seconds - state.seconds;
        if (left < kLeastLeft * tolerance()) return 0;
        const double of_one = seconds_of_pass(1) - seconds_of_pass(0);
        const double spp = std::floor(std::max(0.0, fraction * left - seconds_of_pass(0)) / of_one);
        // The shortest pass may exceed the budget slightly: that may be nearer to it than to stop here.
        const double too_long = seconds_of_pass(least_spp()) - left;
        return too_long < std::min(left, kMostLate * tolerance()) ? std::max(spp, least_spp()) : spp;
    }

    /// Samples still needed for the target error.
    double by_error(const RenderHistory& state) const {
        const double target = job_.budget.error;
        const ErrorEstimate& error = state.error;
        const std::uint32_t done = state.spp();
        if (target == 0 || !error.known ||
            done < (error.rmse > 0 ? tuned<std::uint32_t>("budget.spp_to_believe")
                                   : tuned<std::uint32_t>("budget.spp_to_believe_zero")))
            return kUnlimited;
        if (error.relative() <= target && !job_.budget.strict) return 0;
        if (!outlook_->knows_variance()) return kUnlimited;
        const double rmse = target * error.mean;
        const double variance = ending_variance(*outlook_, job_, outlook_->learning() ? 1 : 0);
        const double needed = std::ceil(spp_to_reach(state, job_, rmse * rmse, variance) * ending_margin(job_));
        return job_.budget.strict ? needed : std::max({needed, least_spp(), tuned("budget.least_share") * done});
    }

    const Resolved& job_;
    BudgetMemory memory_;
    std::optional<Outlook> outlook_;
};

}  // namespace

PassChooser listed_passes(std::vector<PassPlan> passes) {
    return [passes = std::move(passes)](const RenderHistory& state) -> NextPass {
        const std::size_t next = state.passes.size();
        if (next >= passes.size()) return {};
        return {passes[next], passes.back().first_sample + passes.back().spp, passes.size()};
    };
}

PassChooser open_passes(const Resolved& job) {
    return [job](const RenderHistory& state) { return OpenBudget(job, state).next(state); };
}

PassResult finished_pass(const PassPlan& plan, const PassPlan* before, std::vector<PixelEstimate> pixels) {
    PassResult pass{plan.spp, plan.first_sample, std::move(pixels)};
    pass.same_tree = before && !before->record;
    pass.new_technique = before && before->next_event != plan.next_event;
    pass.guided = plan.guided;
    return pass;
}

void show(PassResult pass, const Resolved& job, std::vector<PassResult>& shown) {
    if (job.budget.strict || (shows_last_tree_only(job) && !pass.same_tree)) shown.clear();
    shown.push_back(std::move(pass));
}

PassChooser passes_of(const Resolved& job, std::span<const PassPlan> begun) {
    PassChooser chooser = has_open_budget(job) ? open_passes(job) : listed_passes(continued_passes(job, begun));
    return [chooser = std::move(chooser)](const RenderHistory& state) {
        NextPass next = chooser(state);
        if (next.pass) Decisions::apply(*next.pass, state.decisions, true);
        return next;
    };
}

std::vector<PassPlan> continued_passes(const Resolved& job, std::span<const PassPlan> begun) {
    std::vector<PassPlan> passes = plan_passes(job);
    const auto alike = [](const PassPlan& done, const PassPlan& plan) {
        // A verdict on guiding may have stopped the recording of passes that were planned to record.
        return plan.spp == done.spp && (plan.record == done.record || !done.guided);
    };
    if (begun.size() <= passes.size() && std::equal(begun.begin(), begun.end(), passes.begin(), alike)) return passes;
    const auto unit = static_cast<std::uint32_t>(job.guiding.spp_unit);
    std::uint32_t done = begun.back().first_sample + begun.back().spp;
    passes.assign(begun.begin(), begun.end());
    if (done >= job.budget.spp) return passes;
    for (std::uint32_t remaining = (job.budget.spp - done + unit - 1) / unit; remaining > 0;) {
        const auto index = static_cast<std::uint32_t>(passes.size());
        const std::uint32_t units = next_units(index, remaining);
        remaining -= units;
        passes.push_back(make_pass(job, index, done, units * unit, remaining == 0));
        done += units * unit;
    }
    return passes;
}

bool misses_target(const Job& job, const ErrorEstimate& error) {
    if (job.budget.error == 0) return false;
    // The length of a strict render is a forecast: it has missed only if the error is above the target beyond doubt.
    const double reached = job.budget.strict ? error.relative_low() : error.relative();
    return !error.known || !(reached <= job.budget.error);
}

}  // namespace treefarm
