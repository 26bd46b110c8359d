// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/launch_folder.h"

#include <cerrno>
#include <fstream>
#include <iterator>

#include "common/base/error.h"
#include "common/runs/run_json.h"
#include "coordinator/checkpoint/checkpoint_store.h"
#include "coordinator/run/run_folder.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

}  // namespace

LaunchFolder::LaunchFolder(LaunchedCommand& command) {
    try {
        if (command.folder.empty()) {
            run_ = make_new_run_folder(command.scene);
            made_run_ = true;
            command.folder = run_;
            command.words.insert(command.words.end(), {"--run-dir", run_.string()});
        } else {
            run_ = command.folder;
            made_run_ = fs::create_directories(run_);
        }
        made_own_ = fs::create_directory(own());
    } catch (const fs::filesystem_error& error) {
        throw InputError(Location{run_.empty() ? "runs" : run_.string(), 0, 0},
                         std::string("cannot be the run directory: ") + error.code().message(),
                         "name another with --run-dir");
    }
    lock_.emplace(own(), 0.0, nullptr);
    if (lock_->refused())
        throw InputError(Location{run_.string(), 0, 0}, "another treefarm launch is at work in this folder",
                         "wait for it, or name another folder with --run-dir");
}

std::optional<LifeStatus> LaunchFolder::life(bool& readable) const {
    errno = 0;
    // opened anew each time, so that network file systems check for changes
    std::ifstream file(life_file(), std::ios::binary);
    readable = file.is_open() || errno == ENOENT;
    if (!file.is_open()) return std::nullopt;
    return parse_life_status(std::string(std::istreambuf_iterator<char>(file), {}));
}

std::optional<int> LaunchFolder::summary(const std::string& attempt) const {
    const RunJson summary = read_run_json(run_ / kSummaryFile);
    if (text_in(summary, "attempt") != attempt) return std::nullopt;
    const std::string state = text_in(summary, "state");
    if (state == "interrupted") return 3;
    if (state == "failed") return 1;
    if (state != "done") return std::nullopt;
    return missed_target(summary) ? 4 : 0;
}

bool LaunchFolder::was_taken_by(const std::string& launch) const {
    return text_in(read_run_json(run_ / kStatusFile), "attempt").starts_with(launch + ".");
}

std::uint64_t LaunchFolder::checkpoint() const {
    try {
        return newest_generation(run_);
    } catch (const std::exception&) {  // the folder vanished
        return 0;
    }
}

void LaunchFolder::give_back() const {
    std::error_code ignored;
    if (made_own_) fs::remove_all(own(), ignored);
    if (made_run_) fs::remove(run_, ignored);  // if it is empty
}

}  // namespace treefarm
