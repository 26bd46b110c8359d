#include "coordinator/run_directory.h"

#include <unistd.h>

#include <chrono>
#include <ctime>
#include <future>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/hash.h"
#include "common/config/job_reader.h"
#include "common/config/parse_text.h"
#include "common/image/atomic_file.h"
#include "common/image/png.h"
#include "common/plan/plan_text.h"
#include "common/plan/schedule_file.h"
#include "coordinator/result_image.h"

namespace treefarm {

namespace {

using Json = nlohmann::ordered_json;

std::string time_stamp() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char text[32];
    std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", &local);
    return text;
}

std::filesystem::path choose_path(const Job& job) {
    if (!job.output.directory.empty()) return job.output.directory;
    const std::string name = std::filesystem::path(job.scene.file).stem().string() + "-" + time_stamp();
    std::filesystem::path path = std::filesystem::path("runs") / name;
    for (int k = 2; std::filesystem::exists(path); ++k)  // two runs in one second
        path = std::filesystem::path("runs") / (name + "-" + std::to_string(k));
    return path;
}

void check_output_file(const std::string& file) {
    if (file.empty()) return;
    const std::filesystem::path path(file), folder = path.has_parent_path() ? path.parent_path() : ".";
    if (path.extension() != ".exr")
        throw InputError(Location{file, 0, 0}, "the image is written as EXR", "give it a name that ends in .exr");
    if (!std::filesystem::is_directory(folder))
        throw InputError(Location{file, 0, 0}, "there is no folder " + folder.string(), "make it first");
    if (std::filesystem::is_directory(path)) throw InputError(Location{file, 0, 0}, "is a folder", "name a file");
    if (access(folder.c_str(), W_OK) != 0)  // now, not after hours of rendering
        throw InputError(Location{file, 0, 0}, "nothing can be written in " + folder.string(),
                         "choose another place or change its permissions");
}

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
            {"guiding_gain", r.guiding_gain.all},
            {"guiding_gain_bulk", r.guiding_gain.bulk},
            {"unguided_coverage", r.guiding_gain.coverage},
            {"split", r.plan.split},
            {"splitting_quietens", r.splitting_gain.variance},
            {"splitting_rays", r.splitting_gain.rays},
            {"splitting_found", r.splitting_gain.found},
            {"tree_views", r.tree.views},
            {"tree_cells", r.tree.cells},
            {"tree_bytes", r.tree.bytes},
            {"tree_memory", r.tree.memory},
            {"update_bytes", r.update_bytes},
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

Json farm_json(const Farm& farm) {
    Json workers = Json::array();
    for (const auto& [peer, member] : farm.roster().members())
        workers.push_back({{"worker", peer},
                           {"host", member.hello.host},
                           {"threads", member.hello.threads},
                           {"state", member_state_name(member.state)},
                           {"bad_messages", member.bad_messages}});
    return {{"workers", workers},
            {"reissued_units", farm.reissued_units()},
            {"dropped_results", farm.dropped_results()},
            {"bad_messages", farm.bad_messages()}};
}

/// A run replaces what an earlier run left. A folder that holds something else is none of ours: it might be a person's.
void check_run_directory(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::is_directory(path, error) || std::filesystem::is_empty(path, error)) return;
    if (std::filesystem::exists(path / "passes.csv", error)) return;
    throw InputError(Location{path.string(), 0, 0}, "is no run directory, but a folder that holds other files",
                     "name an empty or a new one with --run-dir");
}

/// What `treefarm inspect` drew of the tree of an earlier run.
void remove_pictures(const std::filesystem::path& folder) {
    if (!std::filesystem::is_directory(folder)) return;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".png" || entry.path().filename() == "inspect.json")
            std::filesystem::remove(entry.path());
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

RunDirectory::RunDirectory(const Job& job, const RunFacts& facts, const EffectPlan& plan)
    : job_(job), facts_(facts), approximations_(plan.approximations), path_(choose_path(job)) {
    check_output_file(job.output.file);
    check_run_directory(path_);
    try {
        std::filesystem::create_directories(path_);
        // A run that ends early must not stand beside the image or the log of another.
        for (const char* stale :
             {"summary.json", "status.json", "image.exr", "preview.png", "log.txt", "schedule.toml", "tree.bin"})
            std::filesystem::remove(path_ / stale);
        remove_pictures(path_ / "inspect");
        write_text("job.toml", write_job(job));
        write_text("plan.txt", plan_text(plan, job.scene.file));
        write_text("plan.json", plan_json(plan, job.scene.file));
        passes_csv_ = pass_csv_header() + "\n";
        write_text("passes.csv", passes_csv_);
    } catch (const std::exception& error) {  // better now than after the render
        throw InputError(Location{path_.string(), 0, 0}, std::string("cannot be the run directory: ") + error.what(),
                         "name another with --run-dir");
    }
}

void RunDirectory::write_text(const std::string& name, const std::string& text, Outlives outlives) const {
    write_file_atomically(path_ / name, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, outlives);
}

void RunDirectory::write_status(const RenderProgress& progress, double elapsed_seconds) {
    if (elapsed_seconds - last_status_ < 1.0) return;
    last_status_ = elapsed_seconds;
    const double left = progress.fraction > 0 ? elapsed_seconds * (1 - progress.fraction) / progress.fraction : 0.0;
    const Json status = {{"state", run_state_name(RunState::running)},
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
                         {"time", std::time(nullptr)}};
    write_text("status.json", status.dump(2) + "\n", Outlives::process);
}

void RunDirectory::add_pass(const PassReport& report) {
    passes_csv_ += pass_csv_line(report) + "\n";
    passes_.push_back(report.plan);
    write_passes(Outlives::process);
}

void RunDirectory::write_passes(Outlives outlives) const {
    write_text("passes.csv", passes_csv_, outlives);
    write_text("schedule.toml", write_schedule(passes_), outlives);
}

void RunDirectory::write_image(const RenderResult& result) {
    if (result.passes.empty()) return;
    std::future<void> preview = std::async(std::launch::async, [&] {
        write_png(path_ / "preview.png", result_colours(result.image, result.width, result.height));
    });
    if (job_.guiding.type != GuidingType::none && result.tree.trained) {
        const Bytes tree = encode_tree(result.tree);
        write_file_atomically(path_ / "tree.bin", tree);
        tree_file_hash_ = hash_text(hash_bytes(tree));
    }
    const Image channels = result_channels(result.image, result.width, result.height);
    const PassReport& last = result.passes.back();
    Attributes attributes = {
        {"treefarm.version", kProgramVersion},
        {"treefarm.build", facts_.fingerprint.text()},
        {"treefarm.spp", std::to_string(result.spp)},
        {"treefarm.job", write_job(job_)},
        {"treefarm.scene_hash", hash_text(facts_.scene_hash)},
        {"treefarm.image_hash", hash_text(result.image_hash)},
        {"treefarm.tree_hash", hash_text(result.tree_hash)},
        {"treefarm.passes", passes_csv_},
        {"treefarm.schedule", write_schedule(passes_)},
    };
    if (last.error.known) {
        attributes["treefarm.error"] = number_text(last.error.relative());
        attributes["treefarm.estimated_rmse"] = number_text(last.error.rmse);
    }
    if (last.error.has_interval) {
        attributes["treefarm.error_low"] = number_text(last.error.relative_low());
        attributes["treefarm.error_high"] = number_text(last.error.relative_high());
    }
    write_exr(path_ / "image.exr", channels, attributes);
    if (!job_.output.file.empty()) write_exr(job_.output.file, channels, attributes);
    preview.get();
}

void RunDirectory::write_summary(RunState state, const RenderResult& result, const Farm* farm, double elapsed_seconds,
                                 const std::string& error) {
    Json summary = {{"state", run_state_name(state)},
                    {"version", kProgramVersion},
                    {"command", facts_.command},
                    {"scene", job_.scene.file},
                    {"scene_hash", hash_text(facts_.scene_hash)},
                    {"fingerprint", hash_text(facts_.fingerprint.hash())},
                    {"build", build_json(facts_.fingerprint)},
                    {"width", result.width},
                    {"height", result.height},
                    {"spp", result.spp},
                    {"seconds", elapsed_seconds},
                    {"image_hash", result.spp > 0 ? hash_text(result.image_hash) : ""},
                    {"tree_hash", result.spp > 0 ? hash_text(result.tree_hash) : ""},
                    {"tree_file_hash", tree_file_hash_},
                    {"image_error", result.passes.empty() ? Json() : error_json(result.passes.back().error)},
                    {"halving", result.passes.empty() ? Json() : forecast_json(result.passes.back().halving)},
                    {"pass_weights", result.image.weight}};
    if (job_.budget.error > 0 && !result.passes.empty())
        summary["target"] = {{"relative_error", job_.budget.error},
                             {"reached", !misses_target(job_, result.passes.back().error)}};
    if (!error.empty()) summary["error"] = error;
    summary["approximations"] = Json::array();
    for (const Approximation& approximation : approximations_)
        summary["approximations"].push_back(approximation_text(approximation));
    summary["passes"] = Json::array();
    for (const PassReport& report : result.passes)
        summary["passes"].push_back(pass_json(report));
    if (farm) summary["farm"] = farm_json(*farm);
    if (!passes_.empty()) write_passes(Outlives::power);
    write_text("summary.json", summary.dump(2) + "\n");
    const Json status = {
        {"state", run_state_name(state)}, {"spp_done", result.spp}, {"elapsed_seconds", elapsed_seconds}};
    write_text("status.json", status.dump(2) + "\n");
}

}  // namespace treefarm
