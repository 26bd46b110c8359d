// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/host_pool.h"

#include <algorithm>
#include <sstream>

#include "common/base/error.h"
#include "common/base/text/parse_text.h"

namespace treefarm {

namespace {

constexpr int kMostLosses = 2;

std::string first_part(const std::string& host) {
    return host.substr(0, host.find('.'));
}

bool is_address(const std::string& host) {
    return host.find_first_not_of("0123456789.") == std::string::npos;
}

}  // namespace

std::vector<HostLine> parse_hostfile(const std::string& text, const std::string& file) {
    std::vector<HostLine> hosts;
    std::istringstream lines(text);
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
        ++number;
        std::istringstream words(line.substr(0, line.find('#')));
        HostLine host;
        if (!(words >> host.host)) continue;
        if (host.host.starts_with('-') || host.host.find("@-") != std::string::npos)
            throw InputError(Location{file, number, static_cast<int>(line.find(host.host)) + 1},
                             "\"" + host.host + "\" is no host: ssh would take it for an option",
                             "begin each line with a host's name: node1 slots=2");
        host.text = line;
        for (std::string word; words >> word;)
            if (word.starts_with("slots="))
                if (const auto slots = parse_unsigned(std::string_view(word).substr(6)))
                    host.slots = static_cast<int>(std::min<std::uint64_t>(*slots, 1 << 20));
        hosts.push_back(host);
    }
    return hosts;
}

std::string hostfile_text(const std::vector<HostLine>& hosts) {
    std::string text;
    for (const HostLine& host : hosts)
        text += host.text + "\n";
    return text;
}

bool is_same_host(const std::string& a, const std::string& b) {
    if (a == b) return true;
    return !is_address(a) && !is_address(b) && first_part(a) == first_part(b);
}

HostPool::HostPool(std::vector<HostLine> hosts, const std::string& here) : hosts_(std::move(hosts)) {
    std::stable_partition(hosts_.begin(), hosts_.end(), [&](const HostLine& line) {
        return is_same_host(line.host, here) || line.host == "localhost" || line.host == "127.0.0.1";
    });
}

std::vector<HostLine> HostPool::choose(const std::set<std::string>& unreachable) const {
    std::vector<HostLine> chosen;
    for (const HostLine& line : hosts_)
        if (!unreachable.contains(line.host) && !resting_.contains(line.host)) chosen.push_back(line);
    return chosen;
}

void HostPool::note_end(const std::vector<LifeWorker>& workers) {
    resting_.clear();
    for (const HostLine& line : hosts_) {
        const bool lost = std::any_of(workers.begin(), workers.end(), [&](const LifeWorker& worker) {
            return worker.lost && is_same_host(worker.host, line.host);
        });
        if (!lost || ++losses_[line.host] < kMostLosses) continue;
        losses_[line.host] = 0;
        resting_.insert(line.host);
    }
}

}  // namespace treefarm
