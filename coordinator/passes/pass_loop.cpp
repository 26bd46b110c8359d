// SPDX-License-Identifier: Apache-2.0
#include "coordinator/passes/pass_loop.h"

#include <algorithm>
#include <new>
#include <utility>

#include "common/base/hash.h"
#include "common/plan/schedule/kernel.h"

namespace treefarm {

namespace {

class PassLoop {
  public:
    PassLoop(Farm& farm, const Resolved& job, const PassChooser& choose, RenderState state, int width, int height,
             const PassHooks& hooks)
        : farm_(farm),
          job_(job),
          choose_(choose),
          hooks_(hooks),
          state_(std::move(state)),
          seconds_before_(state_.partial ? state_.partial->run_seconds : state_.history.seconds) {
        result_.width = width;
        result_.height = height;
    }

    RenderResult run() {
        try {
            if (!state_.reports.empty()) show_finished();
            render_passes();
            result_.tree = ended_with_ ? std::move(*ended_with_) : state_.tree;
        } catch (...) {
            hand_over();
            if (hooks_.on_failure) hooks_.on_failure(std::move(result_));
            throw;
        }
        hand_over();
        return std::move(result_);
    }

  private:
    /// Gives the state to on_last_state, unless a pass was being added to it.
    void hand_over() {
        if (!whole_ || !hooks_.on_last_state) return;
        try {
            if (collecting_) note_partial_pass();
        } catch (const std::bad_alloc&) {  // the finished passes are kept
        }
        if (!state_.reports.empty() || state_.partial)
            farm_.beat_during([&] { hooks_.on_last_state(std::move(state_)); });
    }

    /// Adds the partial results of the present pass to the state.
    void note_partial_pass() {
        PartialPass partial;
        farm_.fill(partial);
        if (partial.done.empty() && partial.poison_units.empty()) return;
        partial.memory = collecting_->memory;
        partial.collect_seconds = collecting_->before + collecting_->clock.seconds();
        partial.run_seconds = run_seconds();
        state_.partial = std::move(partial);
    }

    /// Shows the image of passes that were finished before a resume.
    void show_finished() {
        farm_.beat_during([&] {
            PassVariance known;
            combine_films(state_, job_, result_);
            describe_image(state_, job_, result_, known);
        });
        set_result();
        clock_.restart();  // combining them again is not rendering
    }

    void render_passes() {
        NextPass next = choose_next(true);
        if (state_.partial) {  // a partial pass is finished in any case, with its own plan
            next.pass = state_.partial->plan;
            next.memory = state_.partial->memory;
        }
        while (next.pass) {
            const Timer timer;
            PassPlan plan = *next.pass;
            plan.kernel = kernel_of(job_, plan, facts_of(state_.tree));
            PassReport report;
            report.plan = plan;
            broadcast(plan, report);
            if (!collect(plan, next, report)) {
                result_.interrupted = true;
                if (hooks_.on_interruption) hooks_.on_interruption(result_);
                break;
            }
            if (hooks_.on_collected) hooks_.on_collected();
            DevelopedState developed;
            whole_ = false;
            add_film(state_, job_, collected(plan));
            farm_.beat_during([&] { develop(developed, report); });
            next = look_ahead(next, report);
            farm_.beat_during([&] { learn_from(plan, next, report); });
            finish(std::move(developed), report, timer.seconds());
        }
    }

    /// Next pass. An existing tree guides it as it was refined, even if the pass was planned differently then.
    NextPass choose_next(bool has_tree) {
        state_.history.threads = thread_count();
        NextPass next = choose_(state_.history);
        if (next.pass && has_tree && state_.last_tree) next.pass->last_tree = *state_.last_tree;
        if (next.pass) Decisions::apply(*next.pass, state_.history.decisions, false);
        return next;
    }

    void broadcast(const PassPlan& plan, PassReport& report) {
        state_.tree.set_pass(plan.index);  // also if the previous pass taught nothing
        Bytes encoded = state_.tree.encode();
        coming_tree_hash_ = hash_bytes(encoded);
        report.tree = tree_figures(state_.tree, encoded.size());
        farm_.begin_pass(plan, state_.tree, std::move(encoded), result_.width, result_.height,
                         state_.partial ? &*state_.partial : nullptr);
        report.seconds.all = state_.partial ? state_.partial->collect_seconds : 0.0;
        state_.partial.reset();  // from now on the farm collects it
    }

    /// Collects the results of a pass; false if it was interrupted.
    bool collect(const PassPlan& plan, const NextPass& chosen, PassReport& report) {
        collecting_ = Collecting{chosen.memory, report.seconds.all, kept_value()};
        while (!farm_.pass_complete()) {
            if (hooks_.interrupted && hooks_.interrupted()) return false;
            farm_.step();
            tell_progress(plan, chosen);
            if (hooks_.state_due && hooks_.state_due()) show_partial_pass();
        }
        const double seconds = collecting_->before + collecting_->clock.seconds();
        collecting_.reset();
        if (is_first_) loading_seconds_ = farm_.first_request_seconds();
        report.seconds.broadcast = farm_.broadcast_seconds();
        report.seconds.collect = std::max(0.0, seconds - report.seconds.broadcast);
        return true;
    }

    /// Offers the state with the partial pass, if it has grown: a supervisor counts a repeated state as progress.
    void show_partial_pass() {
        const std::uint64_t value = kept_value();
        if (value == std::exchange(collecting_->kept, value)) return;
        note_partial_pass();
        if (state_.partial && hooks_.on_state) hooks_.on_state(state_);
        state_.partial.reset();
    }

    /// Value that changes whenever the partial pass has more results to save.
    std::uint64_t kept_value() const {
        std::uint64_t value = farm_.ledger().done();
        for (const PoisonUnit& unit : farm_.ledger().poison_units())
            value += unit.deaths;
        return value;
    }

    CollectedPass collected(const PassPlan& plan) {
        CollectedPass pass{plan, farm_.take_pixels(), {}, farm_.collector().totals()};
        if (state_.aovs.requested()) pass.aovs = farm_.take_aovs();
        return pass;
    }

    void develop(DevelopedState& developed, PassReport& report) {
        Timer timer;
        combine_films(state_, job_, developed);
        report.seconds.film = timer.seconds();
        timer.restart();
        fill_from_collector(report, farm_.collector(), state_.tree);
        describe_image(state_, job_, developed, report.variance);
        state_.history.error = report.error = developed.error;
        judge(state_, job_, *developed.image, static_cast<std::size_t>(result_.width),
              Decisions::evidence(farm_.collector().evidence().of(kDecisionsEvidence)), report);
        report.seconds.error = timer.seconds();
    }

    NextPass look_ahead(const NextPass& finished, PassReport& report) {
        const double before = state_.reports.empty() ? 0.0 : state_.reports.back().seconds.refine;
        const PassSeconds& s = report.seconds;
        const double loading = is_first_ ? loading_seconds_ : 0.0;
        PassFacts facts;
        facts.spp = report.plan.spp;
        facts.spp_before = report.plan.first_sample;
        facts.mse_of_sample = report.variance.mse_of_sample;
        facts.stuv_trimmed = report.variance.stuv_trimmed;
        facts.collect_seconds = s.collect;
        facts.overhead_seconds = std::max(0.0, s.broadcast - loading) + s.film + s.error + before;
        facts.trace_core_seconds = report.stats.trace_seconds;
        facts.record_core_seconds = s.splat;
        facts.threads = thread_count();
        facts.record = report.plan.record;
        facts.next_event = report.plan.next_event;
        RenderHistory& history = state_.history;
        history.passes.push_back(facts);
        history.budget = finished.memory;
        history.threads = facts.threads;
        history.seconds = report.run_seconds = seconds_before_ + clock_.seconds() - loading_seconds_;
        report.halving = forecast_error(history, job_, 0.5 * report.error.relative());
        if (job_.budget.error > 0) report.target = forecast_error(history, job_, job_.budget.error);
        return choose_next(!report.plan.record);
    }

    void learn_from(const PassPlan& plan, const NextPass& next, PassReport& report) {
        if (!plan.record) return;
        if (!next.pass) {
            if (!hooks_.on_state) return;  // no resume is possible here
            ended_with_ = state_.tree;
        }
        const Timer timer;
        learn(state_, job_, plan, next.pass, farm_.take_evidence(kGuideEvidence), report);
        report.seconds.refine = timer.seconds();
    }

    void finish(DevelopedState developed, PassReport& report, double seconds) {
        report.seconds.all += seconds;
        report.spp_done = report.plan.first_sample + report.plan.spp;
        report.workers = farm_.roster().present_count();
        report.threads = thread_count();
        count_idle(report);
        // Without exceptions in between: an earlier failure leaves the state of the previous pass complete.
        state_.reports.push_back(report);
        state_.tree_hash = coming_tree_hash_;
        whole_ = true;
        static_cast<DevelopedState&>(result_) = std::move(developed);
        set_result();
        is_first_ = false;
        if (hooks_.on_pass) hooks_.on_pass(report, *result_.image);
        farm_.beat_during([&] {  // copies of a large image take long
            if (hooks_.on_result) hooks_.on_result(result_);
            if (hooks_.on_state) hooks_.on_state(state_);
        });
    }

    void set_result() {
        result_.passes = state_.reports;
        result_.spp = state_.spp();
        result_.tree_hash = state_.tree_hash;
    }

    std::uint32_t thread_count() const { return static_cast<std::uint32_t>(farm_.roster().thread_count()); }

    /// Seconds of rendering; preparing the scene before the first pass does not count.
    double run_seconds() const {
        if (!is_first_) return seconds_before_ + clock_.seconds() - loading_seconds_;
        const double loading = farm_.first_request_seconds();
        return seconds_before_ + (loading > 0 ? std::max(0.0, clock_.seconds() - loading) : 0.0);
    }

    void tell_progress(const PassPlan& plan, const NextPass& chosen) {
        if (!hooks_.on_progress) return;
        const Ledger& ledger = farm_.ledger();
        const double of_pass = static_cast<double>(ledger.done()) / static_cast<double>(ledger.total());
        RenderProgress progress;
        progress.pass = plan.index;
        progress.pass_count = chosen.pass_count;
        progress.spp_done = result_.spp;
        progress.spp_total = chosen.spp_total;
        if (chosen.spp_total > 0)
            progress.fraction = std::min(1.0, (plan.first_sample + of_pass * plan.spp) / chosen.spp_total);
        progress.error = state_.history.error;
        progress.workers = farm_.roster().present_count();
        progress.units = ledger.done();
        progress.rays = farm_.rays_traced();
        progress.run_seconds = run_seconds();
        if (!result_.passes.empty()) {
            progress.target = result_.passes.back().target;
            progress.target_since = result_.passes.back().run_seconds;
        }
        hooks_.on_progress(progress);
    }

    Farm& farm_;
    const Resolved& job_;
    const PassChooser& choose_;
    const PassHooks& hooks_;
    RenderState state_;
    RenderResult result_;  ///< result shown to the callbacks
    std::uint64_t coming_tree_hash_ = 0;
    std::optional<AnyModel> ended_with_;  ///< the last pass's tree, if a later one was learned that guides no pass
    /// A pass whose results are being collected.
    struct Collecting {
        BudgetMemory memory;  ///< NextPass::memory
        double before;        ///< seconds of collecting before a resume
        std::uint64_t kept;   ///< kept_value() of the newest state that was offered or resumed
        Timer clock{};
    };
    std::optional<Collecting> collecting_;
    Timer clock_;
    const double seconds_before_;  ///< seconds of the render before a resume
    double loading_seconds_ = 0;   ///< until the first worker had scene and tree and requested units
    bool is_first_ = true;         ///< first pass since the start or resume
    bool whole_ = true;            ///< the state is one between two passes
};

}  // namespace

RenderResult run_passes(Farm& farm, const Resolved& job, const PassChooser& choose, RenderState state, int width,
                        int height, const PassHooks& hooks) {
    return PassLoop(farm, job, choose, std::move(state), width, height, hooks).run();
}

RenderResult run_passes(Farm& farm, const Resolved& job, const PassChooser& choose, AnyModel tree, int width,
                        int height, const PassHooks& hooks) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return run_passes(farm, job, choose, first_state(job, std::move(tree), pixels), width, height, hooks);
}

}  // namespace treefarm
