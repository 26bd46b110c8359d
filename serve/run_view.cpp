// SPDX-License-Identifier: Apache-2.0
#include "serve/run_view.h"

#include <signal.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <limits>

#include "common/base/host.h"
#include "common/base/printable.h"
#include "serve/file_json.h"
#include "serve/pass_table.h"

namespace treefarm {

namespace {

/// Silence after which a render is not believed to live, seconds: docs/use/outputs.md.
constexpr double kSilence = 60.0;

/// Seconds after which one is that has no process on this machine either.
constexpr double kGone = 3.0;

constexpr std::size_t kLogBytes = 16 << 10;
constexpr std::size_t kTableBytes = 16 << 20;

/// What of a run's files both views need.
struct RunFiles {
    FileJson status, summary;
    std::string state;
};

/// The number of a process; 0: none.
int process_of(const FileJson& status) {
    const FileJson pid = number_of(status, "pid");
    if (!pid.is_number_integer()) return 0;
    const auto number = pid.get<std::int64_t>();
    return number > 0 && number <= std::numeric_limits<int>::max() ? static_cast<int>(number) : 0;
}

std::string state_of(const FileJson& status, const Here& here) {
    const FileJson state = text_of(status, "state");
    if (!state.is_string()) return "unknown";
    const FileJson time = number_of(status, "time");
    if (state != "running" || !time.is_number()) return state;
    const double age = static_cast<double>(here.now) - time.get<double>();
    const int process = process_of(status);
    // Numbers of processes may be those of a container that is called like this machine: one that writes lives.
    if (age > kGone && process > 0 && text_of(status, "host") == here.host && !here.has_process(process))
        return "killed";
    return age > kSilence ? "silent" : state;
}

RunFiles read_files(const ConfinedFolder& root, const std::string& path, const Here& here) {
    RunFiles files;
    files.status = read_object(root, joined_path(path, "status.json"));
    files.state = state_of(files.status, here);
    files.summary = read_object(root, joined_path(path, "summary.json"));
    // Until the end it is of an earlier life of the run.
    if (files.summary.value("state", FileJson()) != files.status.value("state", FileJson()))
        files.summary = FileJson::object();
    return files;
}

/// The folder's name; of the root its own.
std::string title_of(const ConfinedFolder& root, const std::string& path) {
    std::error_code error;
    std::filesystem::path whole = path;
    if (path.empty()) whole = std::filesystem::absolute(root.root(), error).lexically_normal();
    if (!whole.has_filename()) whole = whole.parent_path();  // "runs/"
    return whole.filename().string();
}

FileJson entry_of(const ConfinedFolder& root, const std::string& path, const Here& here, const RunFiles& files) {
    const FileJson& status = files.status;
    FileJson error = object_of(status, "image_error");
    if (error.is_null()) error = object_of(files.summary, "image_error");
    const FileJson time = number_of(status, "time");
    const auto picture = root.version(joined_path(path, "preview.png"));
    const bool is_done = files.state == "done";
    return {
        {"kind", "run"},
        {"run", path},
        {"title", title_of(root, path)},
        {"state", files.state},
        {"age_seconds", time.is_number() ? FileJson(static_cast<double>(here.now) - time.get<double>()) : FileJson()},
        {"host", text_of(status, "host")},
        {"fraction", is_done ? FileJson(1.0) : number_of(status, "fraction")},
        {"pass", number_of(status, "pass")},
        {"passes", number_of(status, "passes")},
        {"spp_done", number_of(status, "spp_done")},
        {"spp", number_of(status, "spp")},
        {"elapsed_seconds", number_of(status, "elapsed_seconds")},
        {"seconds_left", number_of(status, "seconds_left")},
        {"workers", number_of(status, "workers")},
        {"rays", number_of(status, "rays")},
        {"error", number_of(error, "relative")},
        {"error_low", number_of(error, "low")},
        {"error_high", number_of(error, "high")},
        {"picture", picture ? FileJson(picture->text()) : FileJson()}};
}

/// A worker as status.json or summary.json lists it, and nothing else.
FileJson worker_of(const FileJson& worker) {
    return {{"worker", number_of(worker, "worker")},
            {"host", text_of(worker, "host")},
            {"threads", number_of(worker, "threads")},
            {"state", text_of(worker, "state")},
            {"losses", number_of(worker, "losses")},
            {"paths_per_second", number_of(worker, "paths_per_second")},
            {"rays", number_of(worker, "rays")},
            {"idle_share", number_of(worker, "idle_share")},
            {"bad_messages", number_of(worker, "bad_messages")}};
}

FileJson farm_of(const RunFiles& files) {
    FileJson farm = object_of(files.status, "farm");
    if (farm.is_null()) farm = object_of(files.summary, "farm");
    if (farm.is_null()) return nullptr;
    FileJson workers = FileJson::array();
    for (const FileJson& worker : array_of(farm, "workers"))
        workers.push_back(worker_of(worker));
    return {{"workers", workers},
            {"reissued_units", number_of(farm, "reissued_units")},
            {"copied_units", number_of(farm, "copied_units")},
            {"dropped_results", number_of(farm, "dropped_results")},
            {"bad_messages", number_of(farm, "bad_messages")}};
}

FileJson forecast_of(const RunFiles& files, const char* key) {
    FileJson forecast = object_of(files.status, key);
    if (forecast.is_null()) forecast = object_of(files.summary, key);
    if (!number_of(forecast, "seconds").is_number() || !number_of(forecast, "relative_error").is_number())
        return nullptr;
    return {{"relative_error", number_of(forecast, "relative_error")},
            {"seconds", number_of(forecast, "seconds")},
            {"spp", number_of(forecast, "spp")},
            {"trust", text_of(forecast, "trust")}};
}

FileJson launch_of(const ConfinedFolder& root, const std::string& path) {
    const FileJson launch = read_object(root, joined_path(path, "launch/status.json"));
    if (launch.empty()) return nullptr;
    return {{"attempt", text_of(launch, "attempt")},
            {"phase", text_of(launch, "phase")},
            {"host", text_of(launch, "host")},
            {"code", number_of(launch, "code")}};
}

/// The last lines of a log, harmless to whoever prints them.
FileJson log_lines(const ConfinedFolder& root, const std::string& path) {
    FileJson lines = FileJson::array();
    const auto text = root.read_end(joined_path(path, "log.txt"), kLogBytes);
    if (!text) return lines;
    std::size_t begin = text->size() == kLogBytes ? text->find('\n') : 0;  // not from the middle of a line on
    begin = begin == std::string::npos ? 0 : begin;
    for (; begin < text->size();) {
        const std::size_t end = std::min(text->find('\n', begin), text->size());
        if (end > begin) lines.push_back(printable(std::string_view(*text).substr(begin, end - begin)));
        begin = end + 1;
    }
    return lines;
}

}  // namespace

Here local_host() {
    return {std::time(nullptr), host_name(),
            [](int pid) { return pid > 0 && (::kill(pid, 0) == 0 || errno != ESRCH); }};
}

nlohmann::ordered_json run_entry(const ConfinedFolder& root, const std::string& path, const Here& here) {
    return entry_of(root, path, here, read_files(root, path, here));
}

nlohmann::ordered_json run_view(const ConfinedFolder& root, const std::string& path, const Here& here) {
    const RunFiles files = read_files(root, path, here);
    FileJson view = entry_of(root, path, here, files);
    view["farm"] = farm_of(files);
    view["halving"] = forecast_of(files, "halving");
    view["target"] = forecast_of(files, "target");
    for (const char* key : {"scene", "command", "image_hash", "tree_hash", "started"})
        view[key] = text_of(files.summary, key);
    view["message"] = text_of(files.summary, "error");
    for (const char* key : {"width", "height"})
        view[key] = number_of(files.summary, key);
    view["launch"] = launch_of(root, path);
    view["table"] = pass_table(root.read(joined_path(path, "passes.csv"), kTableBytes).value_or(""));
    view["log"] = log_lines(root, path);
    return view;
}

}  // namespace treefarm
