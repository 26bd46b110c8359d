// SPDX-License-Identifier: Apache-2.0
#include "serve/run_view.h"

#include <signal.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <limits>
#include <string_view>

#include "common/base/host.h"
#include "common/base/text/printable.h"
#include "serve/file_json.h"
#include "serve/pass_table.h"

namespace treefarm {

namespace {

/// Seconds of silence after which a render's state is "silent": docs/use/outputs.md.
constexpr double kSilence = 60.0;

/// Seconds of silence after which a render without a process on this machine is "killed".
constexpr double kGone = 3.0;

constexpr std::size_t kLogBytes = 64 << 10;
constexpr std::string_view kDetail = " debug: ";  ///< level of the lines for experts, in common/base/log.cpp's format
constexpr std::size_t kTableBytes = 16 << 20;

/// Contents of a run's files for both views.
struct RunFiles {
    FileJson status, summary;
    std::string state;
};

/// Number of the process; 0: none.
int process_of(const FileJson& status) {
    const FileJson pid = number_of(status, "pid");
    if (!pid.is_number_integer()) return 0;
    const auto number = pid.get<std::int64_t>();
    return number > 0 && number <= std::numeric_limits<int>::max() ? static_cast<int>(number) : 0;
}

std::string state_of(const FileJson& status, const Here& here, const std::function<bool()>& is_locked) {
    const FileJson state = text_of(status, "state");
    if (!state.is_string()) return "unknown";
    const FileJson time = number_of(status, "time");
    if (state != "running" || !time.is_number()) return state;
    const double age = static_cast<double>(here.now) - time.get<double>();
    const int process = process_of(status);
    // Process numbers may be those of a container with this machine's name: a render that still writes, or holds the
    // lock of its folder, is alive.
    if (age > kGone && process > 0 && text_of(status, "host") == here.host && !here.has_process(process) &&
        !is_locked())
        return "killed";
    return age > kSilence ? "silent" : state;
}

RunFiles read_files(const ConfinedFolder& root, const std::string& path, const Here& here) {
    RunFiles files;
    files.status = read_object(root, joined_path(path, kStatusFile));
    files.state = state_of(files.status, here, [&] { return root.is_locked(path); });
    files.summary = read_object(root, joined_path(path, kSummaryFile));
    // Before the end, summary.json is from before a resume.
    if (files.summary.value("state", FileJson()) != files.status.value("state", FileJson()))
        files.summary = FileJson::object();
    return files;
}

/// An object of status.json, or of summary.json where that has none.
FileJson object_of(const RunFiles& files, RunKey key) {
    const FileJson object = object_of(files.status, key);
    return object.is_null() ? object_of(files.summary, key) : object;
}

/// Adds numbers of a file's object to a view; null where it has none.
void add_numbers(FileJson& view, const FileJson& object, std::initializer_list<RunKey> keys) {
    for (const RunKey key : keys)
        view[key.name()] = number_of(object, key);
}

/// Name of the folder; for the root, its own.
std::string title_of(const ConfinedFolder& root, const std::string& path) {
    std::error_code error;
    std::filesystem::path whole = path;
    if (path.empty()) whole = std::filesystem::absolute(root.root(), error).lexically_normal();
    if (!whole.has_filename()) whole = whole.parent_path();  // "runs/"
    return whole.filename().string();
}

FileJson entry_of(const ConfinedFolder& root, const std::string& path, const Here& here, const RunFiles& files) {
    const FileJson& status = files.status;
    const FileJson error = object_of(files, "image_error");
    const FileJson time = number_of(status, "time");
    const auto picture = root.version(joined_path(path, kPreviewFile));
    const bool is_done = files.state == "done";
    FileJson entry = {
        {"kind", "run"},
        {"run", path},
        {"title", title_of(root, path)},
        {"state", files.state},
        {"age_seconds", time.is_number() ? FileJson(static_cast<double>(here.now) - time.get<double>()) : FileJson()},
        {"host", text_of(status, "host")},
        {"fraction", is_done ? FileJson(1.0) : number_of(status, "fraction")},
        {"error", number_of(error, "relative")},
        {"error_low", number_of(error, "low")},
        {"error_high", number_of(error, "high")},
        {"picture", picture ? FileJson(picture->text()) : FileJson()}};
    add_numbers(entry, status,
                {"pass", "passes", "spp_done", "spp", "elapsed_seconds", "seconds_left", "workers", "rays"});
    return entry;
}

/// A worker's members in status.json or summary.json that the page shows.
FileJson worker_of(const FileJson& worker) {
    FileJson view = {{"host", text_of(worker, "host")}, {"state", text_of(worker, "state")}};
    add_numbers(
        view, worker,
        {"worker", "threads", "losses", "paths_per_second", "rays", "idle_share", "processor_share", "bad_messages"});
    return view;
}

FileJson farm_of(const RunFiles& files) {
    const FileJson farm = object_of(files, "farm");
    if (farm.is_null()) return nullptr;
    FileJson view = {{"workers", FileJson::array()}};
    for (const FileJson& worker : array_of(farm, "workers"))
        view["workers"].push_back(worker_of(worker));
    add_numbers(view, farm, {"reissued_units", "copied_units", "dropped_results", "bad_messages"});
    return view;
}

FileJson forecast_of(const RunFiles& files, RunKey key) {
    const FileJson forecast = object_of(files, key);
    if (!number_of(forecast, "seconds").is_number() || !number_of(forecast, "relative_error").is_number())
        return nullptr;
    FileJson view = {{"trust", text_of(forecast, "trust")}};
    add_numbers(view, forecast, {"relative_error", "seconds", "spp"});
    return view;
}

FileJson launch_of(const ConfinedFolder& root, const std::string& path) {
    const FileJson launch = read_object(root, joined_path(path, std::string(kLaunchFolder) + "/" + kStatusFile));
    if (launch.empty()) return nullptr;
    return {{"attempt", text_of(launch, "attempt")},
            {"phase", text_of(launch, "phase")},
            {"host", text_of(launch, "host")},
            {"code", number_of(launch, "code")}};
}

/// Whether a line of a log is one that the terminal shows, too: neither its name nor its text holds the level.
bool is_for_all(std::string_view line) {
    const std::size_t level = line.find(": ");
    const bool dated = !line.empty() && line[0] >= '0' && line[0] <= '9';
    return level == std::string_view::npos || !dated || !line.substr(0, level + 2).ends_with(kDetail);
}

/// Last lines of a log, without those for experts, safe to print.
FileJson log_lines(const ConfinedFolder& root, const std::string& path) {
    FileJson lines = FileJson::array();
    const auto text = root.read_end(joined_path(path, kLogFile), kLogBytes);
    if (!text) return lines;
    std::size_t begin = text->size() == kLogBytes ? text->find('\n') : 0;  // skips the first, incomplete line
    begin = begin == std::string::npos ? 0 : begin;
    for (; begin < text->size();) {
        const std::size_t end = std::min(text->find('\n', begin), text->size());
        const std::string_view line = std::string_view(*text).substr(begin, end - begin);
        if (!line.empty() && is_for_all(line)) lines.push_back(printable(line));
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
    for (const RunKey key : std::initializer_list<RunKey>{"scene", "command", "image_hash", "tree_hash", "started"})
        view[key.name()] = text_of(files.summary, key);
    view["message"] = text_of(files.summary, "error");
    add_numbers(view, files.summary, {"width", "height"});
    view["launch"] = launch_of(root, path);
    view["table"] = pass_table(root.read(joined_path(path, kPassesFile), kTableBytes).value_or(""));
    view["log"] = log_lines(root, path);
    return view;
}

}  // namespace treefarm
