// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "coordinator/run/life_status.h"

namespace treefarm {

/// A hostfile line that names a host.
struct HostLine {
    std::string host;
    int slots = 1;
    std::string text;  ///< the whole line
};

/// Hosts of a hostfile; comments and empty lines are skipped. Throws InputError for a name that ssh would take for an
/// option. `file`: name of the file, for the message.
std::vector<HostLine> parse_hostfile(const std::string& text, const std::string& file = "hostfile");
/// Text of a hostfile with these hosts.
std::string hostfile_text(const std::vector<HostLine>& hosts);

/// Whether two names mean one host, as "node1.cluster.org" and "node1" do.
bool is_same_host(const std::string& a, const std::string& b);

/// Hosts available to a render, with the record of lost workers.
class HostPool {
  public:
    /// `here`: name of this host; its line comes first, since files and signals reach it most reliably.
    HostPool(std::vector<HostLine> hosts, const std::string& here);

    /// Hosts of the next attempt, without the `unreachable` ones.
    std::vector<HostLine> choose(const std::set<std::string>& unreachable) const;
    /// Records the end of an attempt with these workers. A host that lost workers in two attempts is skipped in the
    /// next one.
    void note_end(const std::vector<LifeWorker>& workers);

    const std::vector<HostLine>& all() const { return hosts_; }
    /// Hosts skipped in the next attempt.
    const std::set<std::string>& resting() const { return resting_; }

  private:
    std::vector<HostLine> hosts_;
    std::map<std::string, int> losses_;  ///< per host: number of attempts that lost workers there
    std::set<std::string> resting_;
};

}  // namespace treefarm
