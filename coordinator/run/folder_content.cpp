// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/folder_content.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/files/atomic_file.h"
#include "common/base/text/parse_text.h"
#include "common/base/text/printable.h"
#include "coordinator/run/folder_lock.h"
#include "coordinator/run/life_status.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::array<std::string_view, 13> kRunFiles = {
    "status.json", "summary.json",  "job.toml",  "resolved.toml", "plan.txt", "plan.json", "log.txt",
    "passes.csv",  "schedule.toml", "image.exr", "preview.png",   "tree.bin", "join"};

bool has(const fs::path& path) {
    std::error_code error;
    return fs::exists(fs::symlink_status(path, error));
}

/// An object without keys if there is no such file, or it is damaged.
Json read_object(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    Json json = Json::parse(file, nullptr, false);
    return json.is_object() ? json : Json::object();
}

std::string text_of(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_string() ? printable(found->get<std::string>()) : "";
}

std::string number_of(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number_integer() ? std::to_string(found->get<std::int64_t>()) : "";
}

/// A killed run can leave nothing but the file that it was writing.
bool is_leftover(const std::string& name) {
    for (const std::string_view file : kRunFiles)
        if (is_temporary_of(name, std::string(file))) return true;
    return false;
}

bool is_previous(const fs::path& path) {
    const std::string name = path.filename().string(), start = previous_name(1) + "-";
    return name == previous_name(1) ||
           (name.starts_with(start) && parse_unsigned(std::string_view(name).substr(start.size())).has_value());
}

bool holds_nothing(const fs::path& folder) {
    const std::vector<fs::path> previous = previous_runs(folder);
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (entry.path().filename() != kLockFileName && entry.path().filename() != kLaunchFolder &&
            !is_leftover(entry.path().filename().string()) &&
            std::find(previous.begin(), previous.end(), entry.path()) == previous.end())
            return false;
    return true;
}

/// Frames of a shot that were rendered one by one, as a queue does it.
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

std::span<const std::string_view> run_file_names() {
    return kRunFiles;
}

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
    if (has(folder / "study.json") || has(folder / "cells")) return FolderContent::study;
    if (has(folder / "shot.json")) return FolderContent::shot;
    if (has(folder / "passes.csv") || !text_of(read_object(folder / "status.json"), "state").empty())
        return FolderContent::render;
    if (holds_frames(folder)) return FolderContent::shot;
    return holds_nothing(folder) ? FolderContent::nothing : FolderContent::other;
}

std::string render_words(const fs::path& folder) {
    const Json summary = read_object(folder / "summary.json"), status = read_object(folder / "status.json");
    std::string state = text_of(summary, "state"), spp = number_of(summary, "spp");
    if (state.empty()) state = text_of(status, "state");
    if (spp.empty()) spp = number_of(status, "spp_done");
    if (state.empty() || state == "running") state = "broken off";  // nobody has the folder any more
    return state + ", " + (spp.empty() ? "0" : spp) + " spp";
}

std::string writer_words(const fs::path& folder) {
    const Json status = read_object(folder / "status.json");
    const std::string pid = number_of(status, "pid"), host = text_of(status, "host");
    return pid.empty() || host.empty() ? "" : "process " + pid + " on " + host;
}

}  // namespace treefarm
