// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/sweep.h"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <set>
#include <system_error>

#include "common/base/host.h"
#include "common/base/text/parse_text.h"
#include "coordinator/launch/attempt_processes.h"
#include "coordinator/launch/host_keys.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

constexpr const char* kOwnName = "treefarm-launch-";

/// Not a link, of this user, and at least so many seconds old.
bool is_ours(const fs::path& path, std::time_t age = 0) {
    struct stat facts {};
    return lstat(path.c_str(), &facts) == 0 && facts.st_uid == geteuid() && !S_ISLNK(facts.st_mode) &&
           std::time(nullptr) - facts.st_ctime >= age;
}

bool is_dead(std::uint64_t pid) {
    return pid > 0 && pid < (std::uint64_t{1} << 31) && ::kill(static_cast<pid_t>(pid), 0) != 0 && errno == ESRCH;
}

/// "treefarm-launch-123-abc" of a dead process 123.
bool is_dead_launch(const std::string& name) {
    const std::string start = kOwnName;
    if (!name.starts_with(start)) return false;
    const auto pid = parse_unsigned(std::string_view(name).substr(start.size(), name.rfind('-') - start.size()));
    return pid && is_dead(*pid);
}

int discard(const fs::path& path) {
    std::error_code error;
    fs::remove_all(path, error);
    return !error;
}

int sweep_launches(const fs::path& folder) {
    int removed = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (is_dead_launch(entry.path().filename().string()) && is_ours(entry.path())) removed += discard(entry.path());
    return removed;
}

/// TMP/ompi.HOST.UID/pid.123 of a dead mpirun 123.
int sweep_sessions() {
    const fs::path sessions =
        temporary_folder() / ("ompi." + fs::path(host_name()).string() + "." + std::to_string(geteuid()));
    if (!is_ours(sessions)) return 0;
    int removed = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(sessions, error)) {
        const std::string name = entry.path().filename().string();
        if (!name.starts_with("pid.") || !is_ours(entry.path())) continue;
        if (const auto pid = parse_unsigned(std::string_view(name).substr(4)); pid && is_dead(*pid))
            removed += discard(entry.path());
    }
    return removed;
}

/// Files below a folder that any process which we may look into has in its memory.
std::set<std::string> mapped_files(const std::string& folder) {
    std::set<std::string> files;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator("/proc", error)) {
        if (!parse_unsigned(entry.path().filename().string())) continue;
        std::ifstream maps(entry.path() / "maps");
        for (std::string line; std::getline(maps, line);)
            if (const std::size_t at = line.find(folder + "/"); at != std::string::npos) files.insert(line.substr(at));
    }
    return files;
}

int sweep_shared_memory() {
    const fs::path folder = shared_memory_folder();
    const std::string start = "vader_segment." + host_name() + "." + std::to_string(geteuid()) + ".";
    constexpr std::time_t kSeconds = 10;  // between a file's making and its mapping
    std::set<fs::path> found;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
        if (entry.path().filename().string().starts_with(start) && is_ours(entry.path(), kSeconds))
            found.insert(entry.path());
    if (found.empty()) return 0;
    const std::set<std::string> mapped = mapped_files(folder.string());
    int removed = 0;
    for (const fs::path& path : found)
        if (!mapped.contains(path.string())) removed += discard(path);
    return removed;
}

/// Secrets of attempts that have no process here: a launch on another host was killed, or lost this host.
int sweep_keys() {
    constexpr std::time_t kSeconds = 600;  // between a secret's arrival and the process that it is for
    const std::string start = kHostKeyName;
    int removed = 0;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(temporary_folder(), error)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(start) && is_ours(entry.path(), kSeconds) &&
            attempt_processes(name.substr(start.size())).empty())
            removed += discard(entry.path());
    }
    return removed;
}

}  // namespace

fs::path temporary_folder() {
    const char* const asked = std::getenv("TMPDIR");
    return asked && *asked ? fs::path(asked) : fs::path("/tmp");
}

fs::path shared_memory_folder() {
    return "/dev/shm";
}

OwnFolder::OwnFolder(const fs::path& parent) {
    std::string name = (parent / (kOwnName + std::to_string(getpid()) + "-XXXXXX")).string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
}

OwnFolder::~OwnFolder() {
    if (!path_.empty()) discard(path_);
}

void OwnFolder::empty() const {
    std::error_code error;
    if (!path_.empty())
        for (const auto& entry : fs::directory_iterator(path_, error))
            discard(entry.path());
}

int sweep() {
    return sweep_launches(temporary_folder()) + sweep_launches(shared_memory_folder()) + sweep_sessions() +
           sweep_shared_memory() + sweep_keys();
}

}  // namespace treefarm
