// SPDX-License-Identifier: Apache-2.0
#include "coordinator/run/run_folder.h"

#include <ctime>
#include <vector>

#include "common/base/files/atomic_file.h"
#include "common/base/refuse.h"
#include "common/runs/run_files.h"
#include "coordinator/run/folder_content.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

/// Seconds within which a killed launcher's ranks have left the folder.
constexpr double kLeavingSeconds = 2.0;

std::string time_stamp() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    char text[32];
    std::strftime(text, sizeof text, "%Y%m%d-%H%M%S", &local);
    return text;
}

fs::path make_folder(const Job& job) {
    fs::path path = job.output.directory;
    try {
        if (path.empty()) return make_new_run_folder(job.scene.file);
        fs::create_directories(path);
    } catch (const fs::filesystem_error& error) {
        refuse(path.empty() ? "runs" : path, std::string("cannot be the run directory: ") + error.code().message(),
               "name another with --run-dir");
    }
    return path;
}

/// Names of a run's files, and of the images that treefarm inspect made of it.
std::vector<std::string> moved_names() {
    std::vector<std::string> names;
    for (const RunFile& file : kRunFiles)
        names.emplace_back(file.name);
    names.insert(names.end(), {kInspectFolder, kCheckpointFolder});
    return names;
}

}  // namespace

fs::path make_new_run_folder(const std::string& scene_file) {
    const std::string name = fs::path(scene_file).stem().string() + "-" + time_stamp();
    fs::create_directories("runs");
    // Two runs may begin in the same second.
    for (int k = 1;; ++k) {
        fs::path path = fs::path("runs") / (k == 1 ? name : name + "-" + std::to_string(k));
        if (fs::create_directory(path)) return path;
    }
}

void refuse_if_at_work(const fs::path& folder) {
    const FolderLock lock(folder, 0.0, nullptr);
    if (!lock.refused()) return;
    const std::string who = writer_words(folder);
    refuse(folder, "is being rendered" + (who.empty() ? "" : " (" + who + ")"), "wait for it, or stop it");
}

RunFolder::RunFolder(const Job& job, FolderUse use, const std::function<bool()>& interrupted)
    : use_(use), path_(make_folder(job)), lock_(path_, kLeavingSeconds, interrupted) {
    check();
    try {
        remove_leftovers();
        if (use_ != FolderUse::resume && folder_content(path_) == FolderContent::render) put_aside();
    } catch (const fs::filesystem_error& error) {
        refuse(path_, std::string("cannot be the run directory: ") + error.what(), "name another with --run-dir");
    }
}

void RunFolder::check() const {
    if (lock_.refused()) {
        const std::string who = writer_words(path_);
        refuse(path_, "another render or study is at work in this folder" + (who.empty() ? "" : " (" + who + ")"),
               use_ == FolderUse::resume ? "wait for it" : "wait for it, or name another folder with --run-dir");
    }
    switch (folder_content(path_)) {
        case FolderContent::nothing:
            return;
        case FolderContent::render:
            if (use_ == FolderUse::fresh)
                refuse(path_, "holds a render (" + render_words(path_) + ")",
                       "go on with it by treefarm resume, replace it with --overwrite, or name another folder with "
                       "--run-dir");
            return;
        case FolderContent::study:
            refuse(path_, "holds a study, which a render does not replace", "name another folder with --run-dir");
        case FolderContent::shot:
            refuse(path_, "holds a shot, which a single render does not replace", "name another folder with --run-dir");
        case FolderContent::other:
            refuse(path_, "is no run directory, but a folder that holds other files",
                   "name an empty or a new one with --run-dir");
    }
}

/// Removes partial files of a killed run.
void RunFolder::remove_leftovers() const {
    for (const auto& entry : fs::directory_iterator(path_))
        for (const RunFile& file : kRunFiles)
            if (is_temporary_of(entry.path().filename().string(), file.name) && !entry.is_directory())
                fs::remove(entry.path());
}

/// Moves an earlier run's files to previous/; other files stay.
void RunFolder::put_aside() {
    for (int k = 1; aside_.empty() || !fs::create_directory(aside_); ++k)
        aside_ = path_ / previous_name(k);
    const std::vector<std::string> names = moved_names();
    // Its status files last: if this is interrupted, the folder still counts as a render.
    for (auto name = names.rbegin(); name != names.rend(); ++name)
        if (fs::exists(fs::symlink_status(path_ / *name))) fs::rename(path_ / *name, aside_ / *name);
}

void RunFolder::give_back() const {
    if (use_ == FolderUse::resume) return;
    std::error_code ignored;
    for (const std::string& name : moved_names()) {
        fs::remove_all(path_ / name, ignored);
        if (!aside_.empty()) fs::rename(aside_ / name, path_ / name, ignored);
    }
    if (!aside_.empty()) fs::remove(aside_, ignored);
    fs::remove(path_, ignored);  // if it is empty
}

bool RunFolder::has_previous() const {
    return !previous_runs(path_).empty();
}

void RunFolder::remove_previous() const {
    std::error_code ignored;  // a remaining folder is visible by its name
    for (const fs::path& run : previous_runs(path_))
        fs::remove_all(run, ignored);
}

}  // namespace treefarm
