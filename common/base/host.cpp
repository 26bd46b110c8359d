// SPDX-License-Identifier: Apache-2.0
#include "common/base/host.h"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <thread>

namespace treefarm {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

std::optional<std::uint64_t> read_number(const fs::path& path) {
    std::string word;
    std::uint64_t value = 0;
    if (!(std::ifstream(path) >> word)) return std::nullopt;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
        return std::nullopt;  // the limit may be the word "max"
    return value;
}

/// The number after `key` in a file of lines "key[:] number ...".
std::optional<std::uint64_t> find_number(const fs::path& path, const std::string& key) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string name;
        std::uint64_t value = 0;
        if (words >> name >> value && name == key) return value;
    }
    return std::nullopt;
}

/// Bytes that a control group may still allocate; its cached files count as free. `prefix`: beginning of the cache
/// entries' names in memory.stat.
std::uint64_t left_of_group(const fs::path& folder, const char* limit_file, const char* usage_file,
                            const char* prefix) {
    const auto limit = read_number(folder / limit_file);
    if (!limit) return kUnlimited;
    const std::uint64_t usage = read_number(folder / usage_file).value_or(0);
    std::uint64_t cache = 0;
    for (const char* kind : {"inactive_file", "active_file"})
        cache += find_number(folder / "memory.stat", std::string(prefix) + kind).value_or(0);
    return *limit - std::min(*limit, usage - std::min(usage, cache));
}

/// Least remainder, in bytes, of the group `path` and all its ancestors below `root`.
std::uint64_t left_of_groups(const fs::path& root, const fs::path& path, const char* limit_file, const char* usage_file,
                             const char* prefix) {
    std::uint64_t least =
        left_of_group(root, limit_file, usage_file, prefix);  // inside a container the own group appears as the root
    fs::path folder = root;
    for (const fs::path& part : path.relative_path()) {
        folder /= part;
        least = std::min(least, left_of_group(folder, limit_file, usage_file, prefix));
    }
    return least;
}

/// Bytes left to this process by its control groups, versions 1 and 2 (/proc/self/cgroup has lines
/// "number:controllers:path").
std::uint64_t left_of_control_groups() {
    const fs::path root = "/sys/fs/cgroup";
    std::uint64_t least = kUnlimited;
    std::ifstream groups("/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);) {
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const fs::path path = line.substr(second + 1);
        if (controllers.empty())
            least = std::min(least, left_of_groups(root, path, "memory.max", "memory.current", ""));
        else if (("," + controllers + ",").find(",memory,") != std::string::npos)
            least = std::min(least, left_of_groups(root / "memory", path, "memory.limit_in_bytes",
                                                   "memory.usage_in_bytes", "total_"));
    }
    return least;
}

}  // namespace

std::string host_name() {
    char name[256] = "";
    gethostname(name, sizeof name - 1);
    return name;
}

Host this_host() {
    Host host;
    host.name = host_name();
    const auto kilobytes = find_number("/proc/meminfo", "MemAvailable:");
    const std::uint64_t available = kilobytes ? *kilobytes * 1024 : kUnlimited;
    const std::uint64_t least = std::min(available, left_of_control_groups());
    host.available_bytes = least == kUnlimited ? 0 : std::max<std::uint64_t>(1, least);
    return host;
}

unsigned affinity_threads() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) == 0) return static_cast<unsigned>(CPU_COUNT(&set));
    return std::max(1u, std::thread::hardware_concurrency());  // more processors than the set holds
}

unsigned host_processors() {
    return static_cast<unsigned>(std::max(1L, sysconf(_SC_NPROCESSORS_ONLN)));
}

std::string processor_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        const std::size_t colon = line.find(": ");
        if (colon != std::string::npos && line.starts_with("model name")) return line.substr(colon + 2);
    }
    return "";
}

}  // namespace treefarm
