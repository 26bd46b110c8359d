// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run_report.h"

#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/base/hash.h"
#include "common/base/host.h"
#include "common/plan/plan_text.h"
#include "coordinator/tail_report.h"

namespace treefarm {

namespace {

using Json = nlohmann::ordered_json;

/// Null where something is not known. What is infinite becomes null by itself.
Json error_json(const ErrorEstimate& error) {
    if (!error.known) return nullptr;
    const auto end = [&](double value) { return error.has_interval ? Json(value) : Json(); };
    return {{"relative", error.relative()},
            {"low", end(error.relative_low())},
            {"high", end(error.relative_high())},
            {"rmse", error.rmse},
            {"rmse_low", end(error.low)},
            {"rmse_high", end(error.high)},
            {"mean", error.mean}};
}

Json forecast_json(const ErrorForecast& forecast) {
    return {{"relative_error", forecast.relative_error},
            {"spp", forecast.spp},
            {"seconds", forecast.seconds},
            {"trust", trust_name(forecast.trust)}};
}

Json pass_json(const PassReport& r) {
    return {{"pass", r.plan.index},
            {"spp", r.plan.spp},
            {"spp_done", r.spp_done},
            {"seconds", r.seconds.all},
            {"phase_seconds", r.seconds.phases()},
            {"run_seconds", r.run_seconds},
            {"core_seconds", r.core_seconds()},
            {"stuv", r.variance.stuv},
            {"stuv_trimmed", r.variance.stuv_trimmed},
            {"stuv_ppg", r.variance.stuv_ppg},
            {"ttuv", r.ttuv()},
            {"image_error", error_json(r.error)},
            {"efficiency", r.efficiency()},
            {"halving", forecast_json(r.halving)},
            {"rays_per_second", r.rays_per_second()},
            {"nonzero_share", r.nonzero_share()},
            {"invalid_samples", r.stats.invalid_samples},
            {"tree_nodes", r.tree.nodes},
            {"tree_regions", r.tree.regions},
            {"guided", r.plan.guided},
            {"guiding_worth", r.guiding_efficiency.efficiency},
            {"guiding_worth_low", r.guiding_efficiency.low()},
            {"guiding_worth_high", r.guiding_efficiency.high()},
            {"next_event_n", r.next_event_samples()},
            {"next_event_low", r.refine.next_event.low},
            {"next_event_saved", r.refine.next_event.saved},
            {"split", r.plan.split},
            {"splitting_quietens", r.splitting_gain.variance},
            {"splitting_rays", r.splitting_gain.rays},
            {"splitting_found", r.splitting_gain.mean_ratio},
            {"light_subpaths", r.has_light_subpaths()},
            {"light_subpaths_quieten", r.light_subpath_gain.noise},
            {"light_subpaths_rays", r.light_subpath_gain.rays},
            {"camera_paths_found", r.light_subpath_gain.mean_ratio},
            {"emitters", r.emitters},
            {"emitters_of_half", r.emitters_of_half},
            {"tree_views", r.tree.views},
            {"tree_cells", r.tree.cells},
            {"tree_bytes", r.tree.bytes},
            {"tree_memory", r.tree.memory},
            {"update_bytes", r.update_bytes},
            {"splat_bytes", r.splat_bytes},
            {"trace_seconds",
             {{"min", r.seconds.trace.min},
              {"mean", r.seconds.trace.mean},
              {"max", r.seconds.trace.max},
              {"max_worker", r.seconds.trace.max_worker}}}};
}

Json build_json(const Fingerprint& build) {
    return {{"source", build.source},
            {"options", build.options},
            {"compiler", build.compiler},
            {"embree", build.embree},
            {"program", hash_text(build.program)}};
}

const char* member_state_name(MemberState state) {
    switch (state) {
        case MemberState::present:
            return "present";
        case MemberState::lost:
            return "lost";
        case MemberState::refused:
            return "refused";
        case MemberState::left:
            return "left";
        case MemberState::barred:
            return "barred";
    }
    return "";
}

/// UTC, to the minute.
std::string time_text(std::time_t time) {
    std::tm parts{};
    gmtime_r(&time, &parts);
    char text[32] = "";
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &parts);
    return text;
}

/// Adds what a reader needs to tell a run that lives from one that was killed.
void add_writer(Json& status, const RunFacts& facts) {
    if (!facts.attempt.empty()) status["attempt"] = facts.attempt;
    status["pid"] = getpid();
    status["host"] = host_name();
    status["time"] = std::time(nullptr);
}

std::string text_of(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// A worker's part of the last finished pass in which its threads neither traced nor recorded; null where that is not
/// known.
Json idle_share(const Member& member, const PassReport* last) {
    if (!last || !last->seconds.worker.contains(member.peer)) return nullptr;
    const double all = last->seconds.all * member.hello.threads;
    return all > 0 ? Json(std::clamp(1 - last->seconds.worker.at(member.peer) / all, 0.0, 1.0)) : Json();
}

/// Lives of a worker that ended while it was needed.
std::uint32_t losses(const Member& member) {
    const bool is_lost = member.state == MemberState::lost || member.state == MemberState::barred;
    return member.lives - (is_lost ? 0 : 1);
}

Json worker_json(const Member& member, const PassReport* last) {
    const auto speed = member.speed.paths_per_second();
    return {{"worker", member.peer},
            {"host", member.hello.host},
            {"threads", member.hello.threads},
            {"state", member_state_name(member.state)},
            {"losses", losses(member)},
            {"paths_per_second", speed ? Json(*speed) : Json()},
            {"rays", member.progress.rays},
            {"idle_share", idle_share(member, last)},
            {"bad_messages", member.bad_messages}};
}

/// `last`: the last finished pass, if there is one.
Json farm_json(const Farm& farm, const PassReport* last) {
    Json workers = Json::array();
    for (const auto& [peer, member] : farm.roster().members())
        workers.push_back(worker_json(member, last));
    return {{"workers", workers},
            {"reissued_units", farm.reissued_units()},
            {"copied_units", farm.copied_units()},
            {"dropped_results", farm.dropped_results()},
            {"bad_messages", farm.bad_messages()}};
}

/// Adds who carries the noise; nulls where none is known.
void add_tails(Json& summary, const TailReport& tails) {
    summary["tail_share"] = tails.share ? Json(*tails.share) : Json();
    summary["tail_origin"] = tails.origin.empty() ? Json() : Json(tails.origin);
    summary["tail_worst"] = Json::array();
    for (const TailSample& sample : tails.worst.worst)
        summary["tail_worst"].push_back({{"pass", sample.pass},
                                         {"x", sample.x},
                                         {"y", sample.y},
                                         {"sample", sample.sample},
                                         {"noise", sample.noise},
                                         {"vertices", sample.origin.vertices},
                                         {"origin", words(sample.origin)}});
}

/// Place of the image on the whole film; null if it is that.
Json crop_json(const CropWindow& crop) {
    if (!crop.is_window()) return {};
    return {{"x", crop.x}, {"y", crop.y}, {"film_width", crop.whole_width}, {"film_height", crop.whole_height}};
}

}  // namespace

const char* run_state_name(RunState state) {
    switch (state) {
        case RunState::running:
            return "running";
        case RunState::done:
            return "done";
        case RunState::interrupted:
            return "interrupted";
        case RunState::failed:
            return "failed";
    }
    return "";
}

std::string status_json(const RunFacts& facts, const RenderProgress& progress, double elapsed_seconds, const Farm* farm,
                        const PassReport* last_pass) {
    const double left = progress.fraction > 0 ? elapsed_seconds * (1 - progress.fraction) / progress.fraction : 0.0;
    Json status = {{"state", run_state_name(RunState::running)},
                   {"pass", progress.pass},
                   {"passes", progress.pass_count},
                   {"spp_done", progress.spp_done},
                   {"spp", progress.spp_total},
                   {"fraction", progress.fraction},
                   {"elapsed_seconds", elapsed_seconds},
                   {"seconds_left", left},
                   {"image_error", error_json(progress.error)},
                   {"workers", progress.workers},
                   {"rays", progress.rays},
                   {"run_seconds", progress.run_seconds}};
    if (last_pass) status["halving"] = forecast_json(last_pass->halving);
    if (last_pass && last_pass->target.relative_error > 0) status["target"] = forecast_json(last_pass->target);
    if (farm) status["farm"] = farm_json(*farm, last_pass);
    add_writer(status, facts);
    return text_of(status);
}

std::string status_json(const RunFacts& facts, RunState state, std::uint32_t spp_done, double elapsed_seconds) {
    Json status = {{"state", run_state_name(state)}, {"spp_done", spp_done}, {"elapsed_seconds", elapsed_seconds}};
    add_writer(status, facts);
    return text_of(status);
}

std::string summary_json(const Job& job, const RunFacts& facts, const RenderResult& result, const Farm* farm,
                         const RunEnd& end) {
    Json summary = {{"state", run_state_name(end.state)},
                    {"version", kProgramVersion},
                    {"command", facts.command},
                    {"scene", job.scene.file},
                    {"scene_hash", hash_text(facts.scene_hash)},
                    {"fingerprint", hash_text(facts.fingerprint.hash())},
                    {"build", build_json(facts.fingerprint)},
                    {"host", host_name()},
                    {"processor", processor_name()},
                    {"started", time_text(std::time(nullptr) - static_cast<std::time_t>(end.elapsed_seconds))},
                    {"width", result.width},
                    {"height", result.height},
                    {"crop", crop_json(facts.crop)},
                    {"spp", result.spp},
                    {"seconds", end.elapsed_seconds},
                    {"image_hash", result.spp > 0 ? hash_text(result.image_hash) : ""},
                    {"aov_hash", result.aovs->empty() ? "" : hash_text(result.aov_hash)},
                    {"tree_hash", result.spp > 0 ? hash_text(result.tree_hash) : ""},
                    {"tree_file_hash", end.tree_file_hash},
                    {"image_error", result.passes.empty() ? Json() : error_json(result.passes.back().error)},
                    {"halving", result.passes.empty() ? Json() : forecast_json(result.passes.back().halving)},
                    {"pass_weights", result.image->weight}};
    add_tails(summary, tail_report(*result.image, result.passes));
    if (job.budget.error > 0 && !result.passes.empty())
        summary["target"] = {{"relative_error", job.budget.error},
                             {"reached", !misses_target(job, result.passes.back().error)}};
    if (!facts.attempt.empty()) summary["attempt"] = facts.attempt;
    if (!end.error.empty()) summary["error"] = end.error;
    summary["approximations"] = Json::array();
    for (const Approximation& approximation : facts.approximations)
        summary["approximations"].push_back(approximation_text(approximation));
    summary["passes"] = Json::array();
    for (const PassReport& report : result.passes)
        summary["passes"].push_back(pass_json(report));
    if (farm) summary["farm"] = farm_json(*farm, result.passes.empty() ? nullptr : &result.passes.back());
    return text_of(summary);
}

}  // namespace treefarm
