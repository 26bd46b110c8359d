// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/run_report.h"

#include <unistd.h>

#include <algorithm>

#include "common/base/hash.h"
#include "common/base/host.h"
#include "common/plan/effects/plan_text.h"
#include "coordinator/run/pass_record.h"
#include "coordinator/words/tail_report.h"

namespace treefarm {

namespace {

using Json = RunJson;

Json build_json(const Fingerprint& build) {
    return {{"source", build.source},
            {"options", build.options},
            {"compiler", build.compiler},
            {"embree", build.embree},
            {"program", hash_text(build.program)}};
}

/// Names in the order of MemberState and RunState.
constexpr const char* kMemberStates[] = {"present", "lost", "refused", "left", "barred"};
constexpr const char* kRunStates[] = {"running", "done", "interrupted", "failed"};

const char* state_name(MemberState state) {
    return kMemberStates[static_cast<std::size_t>(state)];
}

const char* state_name(RunState state) {
    return kRunStates[static_cast<std::size_t>(state)];
}

/// UTC time, to the minute.
std::string time_text(std::time_t time) {
    std::tm parts{};
    gmtime_r(&time, &parts);
    char text[32] = "";
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &parts);
    return text;
}

/// Adds process and host, by which a reader tells a live run from a killed one.
void add_writer(Json& status, const RunFacts& facts) {
    if (!facts.attempt.empty()) status["attempt"] = facts.attempt;
    status["pid"] = getpid();
    status["host"] = host_name();
    status["time"] = std::time(nullptr);
}

std::string text_of(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// Fraction of the last finished pass in which a worker's threads had no unit; null if unknown.
Json idle_share(const Member& member, const PassReport* last) {
    if (!last || !last->seconds.busy.contains(member.peer)) return nullptr;
    const double all = last->seconds.all * member.hello.threads;
    return all > 0 ? Json(std::clamp(1 - last->seconds.busy.at(member.peer) / all, 0.0, 1.0)) : Json();
}

/// PassSeconds::processor_share() of the last finished pass; null if unknown.
Json processor_share(const Member& member, const PassReport* last) {
    const auto share = last ? last->seconds.processor_share(member.peer) : std::nullopt;
    return share ? Json(*share) : Json();
}

/// Number of losses of a worker while it was needed.
std::uint32_t losses(const Member& member) {
    const bool is_lost = member.state == MemberState::lost || member.state == MemberState::barred;
    return member.lives - (is_lost ? 0 : 1);
}

Json worker_json(const Member& member, const PassReport* last) {
    const auto speed = member.speed.paths_per_second();
    return {{"worker", member.peer},
            {"host", member.hello.host},
            {"threads", member.hello.threads},
            {"state", state_name(member.state)},
            {"losses", losses(member)},
            {"paths_per_second", speed ? Json(*speed) : Json()},
            {"rays", member.progress.rays},
            {"idle_share", idle_share(member, last)},
            {"processor_share", processor_share(member, last)},
            {"bad_messages", member.bad_messages}};
}

/// `last`: the last finished pass, or nullptr.
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

/// Adds the samples that carry most noise; nulls if unknown.
void add_tails(Json& summary, const TailReport& tails) {
    summary["tail_share"] = tails.share ? Json(*tails.share) : Json();
    summary["tail_origin"] = tails.origin.empty() ? Json() : Json(tails.origin);
    summary["tail_worst"] = Json::array();
    for (const TailSample& sample : tails.worst.worst)
        summary["tail_worst"].push_back({{"pass", sample.pass + 1},
                                         {"x", sample.x},
                                         {"y", sample.y},
                                         {"sample", sample.sample},
                                         {"noise", sample.noise},
                                         {"vertices", sample.origin.vertices},
                                         {"origin", words(sample.origin)}});
}

/// Window of the image on the whole film; null if it is the whole film.
Json crop_json(const CropWindow& crop) {
    if (!crop.is_window()) return {};
    return {{"x", crop.x}, {"y", crop.y}, {"film_width", crop.whole_width}, {"film_height", crop.whole_height}};
}

}  // namespace

std::string status_json(const RunFacts& facts, const RenderProgress& progress, double elapsed_seconds, const Farm* farm,
                        const PassReport* last_pass) {
    const double left = progress.fraction > 0 ? elapsed_seconds * (1 - progress.fraction) / progress.fraction : 0.0;
    Json status = {{"state", state_name(RunState::running)},
                   {"pass", progress.pass + 1},
                   {"passes", progress.pass_count},
                   {"spp_done", progress.spp_done},
                   {"spp", progress.spp_total},
                   {"fraction", progress.fraction},
                   {"elapsed_seconds", elapsed_seconds},
                   {"seconds_left", left},
                   {"image_error", error_record(progress.error)},
                   {"workers", progress.workers},
                   {"rays", progress.rays},
                   {"run_seconds", progress.run_seconds}};
    if (last_pass) status["halving"] = forecast_record(last_pass->halving);
    if (last_pass && last_pass->target.relative_error > 0) status["target"] = forecast_record(last_pass->target);
    if (farm) status["farm"] = farm_json(*farm, last_pass);
    add_writer(status, facts);
    return text_of(status);
}

std::string status_json(const RunFacts& facts, RunState state, std::uint32_t spp_done, double elapsed_seconds) {
    Json status = {{"state", state_name(state)}, {"spp_done", spp_done}, {"elapsed_seconds", elapsed_seconds}};
    add_writer(status, facts);
    return text_of(status);
}

std::string summary_json(const Job& job, const RunFacts& facts, const RenderResult& result, const Farm* farm,
                         const RunEnd& end) {
    Json summary = {{"state", state_name(end.state)},
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
                    {"image_error", result.passes.empty() ? Json() : error_record(result.passes.back().error)},
                    {"halving", result.passes.empty() ? Json() : forecast_record(result.passes.back().halving)},
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
        summary["passes"].push_back(pass_record(report, kInSummary));
    if (farm) summary["farm"] = farm_json(*farm, result.passes.empty() ? nullptr : &result.passes.back());
    return text_of(summary);
}

}  // namespace treefarm
