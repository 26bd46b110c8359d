// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/folder_content.h"

#include <algorithm>

#include "common/base/files/atomic_file.h"
#include "common/base/text/parse_text.h"
#include "common/base/text/printable.h"
#include "common/runs/run_json.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

bool has(const fs::path& path) {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
}

/// Text of a key as a message can hold it; "" where the file has none.
std::string words_of(const RunJson& json, RunKey key) {
    return printable(text_in(json, key));
}

std::string count_of(const RunJson& json, RunKey key) {
    const RunJson number = number_of(json, key);
    return number.is_number_integer() ? number.dump() : "";
}

/// Whether a file is a partial one of a killed run, which may be all that it left.
bool is_leftover(const std::string& name) {
    return std::any_of(kRunFiles.begin(), kRunFiles.end(),
                       [&](const RunFile& file) { return is_temporary_of(name, file.name); });
}

bool is_previous(const fs::path& path) {
    const std::string name = path.filename().string(), start = previous_name(1) + "-";
    return name == previous_name(1) ||
           (name.starts_with(start) && parse_unsigned(std::string_view(name).substr(start.size())).has_value());
}

/// Whether a render writes an entry of this name again and again.
bool is_of_render_at_work(const std::string& name) {
    for (const char* own : {kScheduleFile, kPreviewFile, kImageFile, kTreeFile, kSummaryFile, kCheckpointFolder})
        if (name == own) return true;
    return false;
}

/// Content of a folder without a render's status. A run directory that was removed while it was rendered may hold what
/// the render wrote meanwhile, and nothing else.
FolderContent content_without_status(const fs::path& folder) {
    const std::vector<fs::path> previous = previous_runs(folder);
    FolderContent content = FolderContent::nothing;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (name == kLockFileName || name == kLaunchFolder || is_leftover(name) ||
            std::find(previous.begin(), previous.end(), entry.path()) != previous.end())
            continue;
        if (!is_of_render_at_work(name)) return FolderContent::other;
        content = FolderContent::render;
    }
    return content;
}

/// Whether a folder holds frames of a shot that were rendered one by one, as by a queue.
bool holds_frames(const fs::path& folder) {
    constexpr std::string_view kStart = "frame.";
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(kStart) && parse_unsigned(std::string_view(name).substr(kStart.size())) &&
            entry.is_directory(error) && folder_content(entry.path()) == FolderContent::render)
            return true;
    }
    return false;
}

}  // namespace

std::string previous_name(int number) {
    return number == 1 ? "previous" : "previous-" + std::to_string(number);
}

std::vector<fs::path> previous_runs(const fs::path& folder) {
    std::vector<fs::path> runs;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (is_previous(entry.path()) && entry.is_directory(error) && !entry.is_symlink(error) &&
            folder_content(entry.path()) == FolderContent::render)
            runs.push_back(entry.path());
    return runs;
}

FolderContent folder_content(const fs::path& folder) {
    std::error_code error;
    if (!fs::is_directory(folder, error)) return has(folder) ? FolderContent::other : FolderContent::nothing;
    if (has(folder / kStudyFile) || has(folder / kCellsFolder)) return FolderContent::study;
    if (has(folder / kShotFile)) return FolderContent::shot;
    if (has(folder / kPassesFile) || !text_in(read_run_json(folder / kStatusFile), "state").empty())
        return FolderContent::render;
    if (holds_frames(folder)) return FolderContent::shot;
    return content_without_status(folder);
}

std::string render_words(const fs::path& folder) {
    const RunJson summary = read_run_json(folder / kSummaryFile), status = read_run_json(folder / kStatusFile);
    std::string state = words_of(summary, "state"), spp = count_of(summary, "spp");
    if (state.empty()) state = words_of(status, "state");
    if (spp.empty()) spp = count_of(status, "spp_done");
    if (state.empty() || state == "running") state = "broken off";  // no process uses the folder any more
    return state + ", " + (spp.empty() ? "0" : spp) + " spp";
}

std::string writer_words(const fs::path& folder) {
    const RunJson status = read_run_json(folder / kStatusFile);
    const std::string pid = count_of(status, "pid"), host = words_of(status, "host");
    return pid.empty() || host.empty() ? "" : "process " + pid + " on " + host;
}

}  // namespace treefarm
