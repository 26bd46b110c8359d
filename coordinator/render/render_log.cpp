// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/render_log.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/hash.h"
#include "common/base/text/duration_text.h"
#include "common/base/text/parse_text.h"
#include "common/config/estimators.h"
#include "common/plan/effects/plan_text.h"
#include "common/runs/run_files.h"
#include "coordinator/input/lint/lint.h"
#include "coordinator/words/decision_text.h"
#include "coordinator/words/pass_text.h"
#include "coordinator/words/tail_report.h"

namespace treefarm {

namespace {

/// Number of black passes after which a render reports that it has found no light.
constexpr std::uint32_t kPassesInTheDark = 3;

std::string size_text(const Film& film) {
    std::string size = fmt::format("{} x {}", film.width, film.height);
    if (!film.crop.is_window()) return size;
    return fmt::format("{} at {},{} of {} x {}", size, film.crop.x, film.crop.y, film.whole_width(),
                       film.whole_height());
}

}  // namespace

RenderLog::RenderLog(const RenderRequest& request, std::filesystem::path folder, const TellMessage& tell)
    : request_(request), folder_(std::move(folder)), log_(make_log("treefarm", folder_ / kLogFile, tell)) {}

void RenderLog::tell_origin() const {
    log_->debug("{}", request_.origin.command);
    if (!request_.origin.launch_warnings.empty()) log_->debug("launch: warning: {}", request_.origin.launch_warnings);
    for (const std::string& warning : request_.content.warnings)
        log_->warn("{}", warning);
    for (const std::string& note : request_.content.notes)
        log_->info("{}", note);
    for (const Approximation& approximation : request_.content.plan.approximations)
        log_->warn("{}", approximation_text(approximation));
}

void RenderLog::tell_start(const RenderState& state, const NextPass& first) const {
    const bool continues = request_.start.checkpoint != nullptr;
    const std::string scene = std::filesystem::path(request_.content.job.scene.file).stem().string();
    log_->info("{} {}, {}, {}; results in {}", continues ? "going on with" : "rendering", scene,
               size_text(request_.content.scene.film), budget_text(first), folder_.string());
    if (continues)
        log_->info("{} passes with {} spp are done{}, {} of rendering", state.reports.size(), state.spp(),
                   state.partial ? ", one is partly done" : "",
                   duration_text(state.partial ? state.partial->run_seconds : state.history.seconds));
    if (continues && request_.content.plan.job.farm.checkpoint_seconds == 0)
        log_->warn("no checkpoints (farm.checkpoint_seconds = 0): that of {} spp stays until the render is done",
                   state.spp());
    log_->debug("{} triangles", request_.content.scene.triangle_count());
}

void RenderLog::tell_pass(const PassReport& pass, const CombinedImage& image, std::size_t pass_count) {
    log_->info("{}", pass_line(pass, pass_count));
    log_->debug("{}", pass_summary(pass, pass_count));
    if (pass_count == 0 || pass.plan.index + 1 < pass_count)
        for (const DecisionText& text : decision_texts(pass))
            log_->debug("from {} on: {}", pass_name(pass.plan.index + 1, 0), text.words);
    const std::string name = pass_name(pass.plan.index, 0);
    for (const InvalidSample& sample : pass.stats.first_invalid)
        log_->warn("radiance ({}, {}, {}) counts as black; reproduce with: {} {},{},{},{}{}", sample.rgb[0],
                   sample.rgb[1], sample.rgb[2], request_.origin.debug_command, sample.pass + 1, sample.x, sample.y,
                   sample.sample, replay_options());
    if (pass.stats.invalid_samples > pass.stats.first_invalid.size())
        log_->warn("{} invalid samples in {} in all", pass.stats.invalid_samples, name);
    if (pass.caps.capped_records > 0 || pass.caps.saturated_cells > 0 || pass.caps.outside_positions > 0)
        log_->warn("{}: {} records capped, {} cells saturated, {} positions outside the tree", name,
                   pass.caps.capped_records, pass.caps.saturated_cells, pass.caps.outside_positions);
    if (pass.splat_caps != SplatCaps{} || pass.saturated_splats > 0)
        log_->warn("{}: {} capped splats, {} saturated sums of splats, {} invalid splats", name, pass.splat_caps.capped,
                   pass.saturated_splats, pass.splat_caps.rejected);
    if (pass.plan.index >= kPassesInTheDark) tell_if_black(image, pass.spp_done);
    tell_if_starved(pass);
}

/// Warns, once for each worker, of processors that its threads did not get.
void RenderLog::tell_if_starved(const PassReport& pass) {
    for (const auto& [worker, busy] : pass.seconds.busy)
        if (const std::string text = processor_time_[worker].add(worker, busy, pass.seconds.worker.at(worker));
            !text.empty())
            log_->warn("{}", text);
}

/// Logs, once, the probable cause of a black image.
void RenderLog::tell_if_black(const CombinedImage& image, std::uint32_t spp) {
    const auto is_dark = [](const Rgb64& mean) { return mean == Rgb64(0.0); };
    if (reported_black_ || !std::all_of(image.mean.begin(), image.mean.end(), is_dark)) return;
    reported_black_ = true;
    const std::vector<Finding> causes = dark_causes(request_.content.scene);
    const Estimator& estimator = estimator_of(request_.content.job);
    std::string why;
    if (causes.empty())
        why = estimator.misses ? fmt::format("; estimator \"{}\": {}", estimator.type, estimator.misses)
                               : "; the cause in the scene is not obvious: no path has hit a light";
    log_->warn("the image is black after {} spp{}", spp, why);
    for (const Finding& cause : causes)
        log_->warn("{}", cause.sentence());
}

void RenderLog::tell_end(const RunEnd& end, const RenderResult& result, bool continued, double part,
                         bool has_previous) {
    if (has_previous)
        log_->warn("an earlier run's files are set aside in {}, until a run in this folder is done",
                   (folder_ / "previous*").string());
    if (end.state == RunState::failed) {
        if (const std::string kept = kept_text(result, part); !kept.empty()) log_->info("{}", kept);
        return;
    }
    if (!continued) {
        log_->warn("interrupted before it was resumed: nothing has changed");
        return;
    }
    if (result.passes.empty()) {
        log_->warn("interrupted before the first pass was finished: there is no image{}",
                   kept_text(result, part).empty() ? "" : "; " + kept_text(result, part));
        return;
    }
    if (end.state == RunState::interrupted) log_->warn("interrupted: {}", kept_text(result, part));
    tell_result(result, end.elapsed_seconds);
}

void RenderLog::tell_result(const RenderResult& result, double elapsed_seconds) {
    tell_if_black(*result.image, result.spp);
    const PassReport& last = result.passes.back();
    log_->debug("{} spp in {:.2f} s, {}; image {} tree {}", result.spp, elapsed_seconds, error_text(last.error),
                hash_text(result.image_hash), hash_text(result.tree_hash));
    if (last.error.rmse > 0 && std::isfinite(last.halving.seconds))
        log_->info("half this error ({:.3g} %) would take {}{} more, {:.0f} spp", 100 * last.halving.relative_error,
                   trust_words(last.halving.trust), rough_duration_text(last.halving.seconds), last.halving.spp);
    if (const TailReport tails = tail_report(*result.image, result.passes); tails.stands_out) {
        log_->info("{}", tail_text(tails));
        log_->debug("{}", tail_command(tails, request_.origin.debug_command, replay_options()));
    }
    const std::string& asked = request_.content.job.output.file;
    log_->info("{}", join_fields({fmt::format("{} spp", result.spp), duration_text(last.run_seconds),
                                  brief_error_text(last.error), "image " + hash_text(result.image_hash),
                                  (asked.empty() ? folder_ / kImageFile : std::filesystem::path(asked)).string()}));
    if (missed_target(request_, result))
        log_->warn("the error is above the {:.3g} % asked for: {}; the image is kept",
                   100 * request_.content.job.budget.error, why_missed(result));
}

std::string RenderLog::budget_text(const NextPass& first) const {
    if (first.pass_count > 0) return fmt::format("{} spp in {} passes", first.spp_total, first.pass_count);
    const Job::Budget& budget = request_.content.job.budget;
    std::string text = budget.error > 0 ? fmt::format("until the error is {:.3g} %", 100 * budget.error) : "";
    if (budget.seconds > 0) text += (text.empty() ? "for " : ", at most ") + limit_text(budget.seconds);
    if (budget.max_spp != Job::Budget{}.max_spp) text += fmt::format(", at most {} spp", budget.max_spp);
    return text;
}

/// Description of the saved results of an unfinished render, with the command that resumes it.
std::string RenderLog::kept_text(const RenderResult& result, double part) const {
    const bool goes_on = request_.storage.checkpoints && request_.content.job.farm.checkpoint_seconds > 0;
    const double share = goes_on && part < 1 ? part : 0;  // 1: of a finished pass
    std::string text;
    if (result.spp > 0) text = fmt::format("kept the {} spp of finished passes", result.spp);
    if (share > 0)
        text += fmt::format("{}{:.0f} % of the unfinished pass", text.empty() ? "kept " : ", and ",
                            std::floor(100 * share));
    if (goes_on && !text.empty()) text += "; go on with: treefarm resume " + shell_quoted(folder_.string());
    return text;
}

std::string RenderLog::why_missed(const RenderResult& result) const {
    const Job::Budget& budget = request_.content.job.budget;
    if (result.spp >= budget.max_spp) return fmt::format("budget.max_spp = {} is reached", budget.max_spp);
    if (budget.seconds > 0) return "the time of " + limit_text(budget.seconds) + " is over";
    return "the last pass was planned too short";
}

std::string RenderLog::replay_options() const {
    const std::filesystem::path run = std::filesystem::absolute(folder_);
    std::string options = " --run-dir " + shell_quoted(run.string());
    if (request_.content.schedule.empty()) options += " --schedule " + shell_quoted((run / kScheduleFile).string());
    return options;
}

bool missed_target(const RenderRequest& request, const RenderResult& result) {
    return !result.interrupted && !result.passes.empty() &&
           misses_target(request.content.plan.job, result.passes.back().error);
}

}  // namespace treefarm
