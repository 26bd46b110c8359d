// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "coordinator/run/life_status.h"

namespace treefarm {

/// A line of a hostfile that names a host.
struct HostLine {
    std::string host;
    int slots = 1;
    std::string text;  ///< the whole line
};

/// The hosts of a hostfile; comments and empty lines are left out.
std::vector<HostLine> parse_hostfile(const std::string& text);
/// A hostfile of these hosts.
std::string hostfile_text(const std::vector<HostLine>& hosts);

/// "node1.cluster.org" and "node1" are one host.
bool is_same_host(const std::string& a, const std::string& b);

/// The hosts that a render may use, and those that it has lost workers on.
class HostPool {
  public:
    /// `here`: this host's name; its line comes first, since files and signals reach it most surely.
    HostPool(std::vector<HostLine> hosts, const std::string& here);

    /// The hosts of the next attempt; `unreachable` have not answered just now.
    std::vector<HostLine> choose(const std::set<std::string>& unreachable) const;
    /// An attempt has ended with these workers. A host that lost some in two attempts is left out of the next one.
    void note_end(const std::vector<LifeWorker>& workers);

    const std::vector<HostLine>& all() const { return hosts_; }

  private:
    std::vector<HostLine> hosts_;
    std::map<std::string, int> losses_;  ///< attempts that lost workers there
    std::set<std::string> resting_;      ///< left out of the next attempt
};

}  // namespace treefarm
