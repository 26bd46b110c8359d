// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/host_probe.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <list>
#include <sstream>
#include <thread>

#include "common/base/host.h"
#include "common/base/timer.h"
#include "coordinator/launch/child_process.h"

namespace treefarm {

namespace {

using Words = std::vector<std::string>;

/// For a host to answer.
constexpr double kProbeSeconds = 10.0;

/// A variable that changes nothing.
const char* const kNothing = "TREEFARM_PROBE=1";

Words host_command(const std::string& host, const std::string& line) {
    Words words;
    if (const char* agent = std::getenv("OMPI_MCA_plm_rsh_agent"); agent && *agent) {
        std::istringstream parts(agent);
        for (std::string part; parts >> part;)
            words.push_back(part);
    } else {
        words = {"ssh", "-o", "BatchMode=yes", "-o", "ConnectTimeout=5"};
    }
    words.push_back(host);
    words.push_back(line);
    return words;
}

bool is_here(const std::string& host) {
    return host == "localhost" || host == "127.0.0.1" || is_same_host(host, host_name());
}

}  // namespace

std::set<std::string> failing_hosts(const std::vector<HostLine>& hosts, const std::string& shell_line, double seconds,
                                    const std::filesystem::path& input) {
    std::list<std::pair<std::string, ChildProcess>> probes;
    for (const HostLine& line : hosts)
        if (!is_here(line.host))
            probes.emplace_back(std::piecewise_construct, std::forward_as_tuple(line.host),
                                std::forward_as_tuple(host_command(line.host, shell_line), kNothing,
                                                      ChildProcess::Heard::all, input.string()));
    const Timer timer;
    std::set<std::string> failing;
    while (!probes.empty() && timer.seconds() < seconds) {
        for (auto probe = probes.begin(); probe != probes.end();)
            if (probe->second.running()) {
                probe->second.take_words();
                ++probe;
            } else {
                if (!probe->second.succeeded()) failing.insert(probe->first);
                probe = probes.erase(probe);
            }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    for (const auto& [host, probe] : probes)
        failing.insert(host);
    return failing;
}

std::set<std::string> unreachable_hosts(const std::vector<HostLine>& hosts) {
    return failing_hosts(hosts, "true", kProbeSeconds);
}

bool is_program(const std::string& name) {
    if (name.find('/') != std::string::npos) return access(name.c_str(), X_OK) == 0;
    const char* const path = std::getenv("PATH");
    std::istringstream folders(path ? path : "/usr/bin:/bin");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((std::filesystem::path(folder) / name).c_str(), X_OK) == 0) return true;
    return false;
}

std::string words_of(const Words& command, double seconds) {
    if (!is_program(command.front())) return "";
    ChildProcess child(command, kNothing, ChildProcess::Heard::all);
    const Timer timer;
    std::string words;
    while (child.running() && timer.seconds() < seconds) {
        words += child.take_words();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return words + child.take_words();
}

}  // namespace treefarm
