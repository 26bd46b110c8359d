// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/launch_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/base/files/atomic_file.h"
#include "common/runs/run_json.h"
#include "coordinator/checkpoint/checkpoint_store.h"
#include "coordinator/launch/own_folder.h"
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

void LaunchFolder::remake() {
    std::error_code error;
    if (fs::is_directory(own(), error)) return;
    fs::create_directories(own(), error);
    lock_.emplace(own(), 0.0, nullptr);
}

std::string LaunchFolder::trouble() {
    remake();
    try {
        probe_folder(own());
        return "";
    } catch (const FileError& error) {
        return run_.string() + ": " + std::strerror(error.code());
    }
}

std::optional<LifeStatus> LaunchFolder::life(bool& readable) const {
    // opened anew each time, so that network file systems check for changes
    const Descriptor file = Descriptor::open(life_file(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK);
    readable = file || errno == ENOENT;
    std::string text;
    char part[4096];
    for (ssize_t count; file && (count = ::read(file.fd(), part, sizeof part)) > 0;)
        text.append(part, static_cast<std::size_t>(count));
    return parse_life_status(text);
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
