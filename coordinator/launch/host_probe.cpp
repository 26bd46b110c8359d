// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/host_probe.h"

#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <list>
#include <sstream>
#include <thread>

#include "common/base/host.h"
#include "common/base/text/printable.h"
#include "common/base/timer.h"
#include "coordinator/launch/child_process.h"

namespace treefarm {

namespace {

using Words = std::vector<std::string>;

/// Seconds for a host's answer.
constexpr double kProbeSeconds = 10.0;

/// Words of Open MPI's agent; empty: ssh.
Words agent_words() {
    const char* const agent = std::getenv("OMPI_MCA_plm_rsh_agent");
    std::istringstream parts(agent ? agent : "");
    return Words(std::istream_iterator<std::string>(parts), {});
}

/// `host` is no option (parse_hostfile()); an agent need not know "--".
Words host_command(const std::string& host, const std::string& line) {
    Words words = agent_words();
    if (words.empty()) words = {"ssh", "-o", "BatchMode=yes", "-o", "ConnectTimeout=5", "--"};
    words.push_back(host);
    words.push_back(line);
    return words;
}

bool is_here(const std::string& host) {
    return host == "localhost" || host == "127.0.0.1" || is_same_host(host, host_name());
}

}  // namespace

std::set<std::string> failing_hosts(const std::vector<HostLine>& hosts, const std::string& shell_line, double seconds,
                                    const std::filesystem::path& input, std::map<std::string, std::string>* said) {
    std::list<std::pair<std::string, ChildProcess>> probes;
    for (const HostLine& line : hosts)
        if (!is_here(line.host))
            probes.emplace_back(std::piecewise_construct, std::forward_as_tuple(line.host),
                                std::forward_as_tuple(host_command(line.host, shell_line), Words(),
                                                      ChildProcess::Heard::all, input.string()));
    const auto hear = [said](auto& probe) {
        const std::string words = probe.second.take_words();
        if (said) (*said)[probe.first] += words;
    };
    const Timer timer;
    std::set<std::string> failing;
    while (!probes.empty() && timer.seconds() < seconds) {
        for (auto probe = probes.begin(); probe != probes.end();)
            if (probe->second.running()) {
                hear(*probe);
                ++probe;
            } else {
                hear(*probe);
                if (!probe->second.succeeded()) failing.insert(probe->first);
                probe = probes.erase(probe);
            }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    for (const auto& [host, probe] : probes)
        failing.insert(host);
    return failing;
}

std::map<std::string, std::string> unreachable_hosts(const std::vector<HostLine>& hosts) {
    std::map<std::string, std::string> said, unreachable;
    for (const std::string& host : failing_hosts(hosts, "true", kProbeSeconds, {}, &said)) {
        const std::string& words = said[host];
        const std::size_t end = words.find_last_not_of(" \r\n"), begin = words.find_last_of("\r\n", end);
        unreachable[host] = end == words.npos ? "" : printable(words.substr(begin + 1, end - begin));
    }
    return unreachable;
}

std::string host_agent() {
    const Words words = agent_words();
    return words.empty() ? "ssh" : printable(words.front());
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
    ChildProcess child(command, {}, ChildProcess::Heard::all);
    const Timer timer;
    std::string words;
    while (child.running() && timer.seconds() < seconds) {
        words += child.take_words();
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return words + child.take_words();
}

}  // namespace treefarm
