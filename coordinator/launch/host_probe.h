// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "coordinator/launch/host_pool.h"

namespace treefarm {

/// Hosts on which a shell line does not succeed within `seconds`, by ssh or by Open MPI's agent
/// (OMPI_MCA_plm_rsh_agent). All are tried at the same time, except this host. `input`: a file for the line's standard
/// input, or empty. `said`: output of the agent, by host; or nullptr.
std::set<std::string> failing_hosts(const std::vector<HostLine>& hosts, const std::string& line, double seconds,
                                    const std::filesystem::path& input = {},
                                    std::map<std::string, std::string>* said = nullptr);

/// Hosts that do not answer, each with the agent's last line, printable: the reason, or "".
std::map<std::string, std::string> unreachable_hosts(const std::vector<HostLine>& hosts);

/// Name of the program that reaches other hosts: "ssh", or Open MPI's agent.
std::string host_agent();

/// Whether a program is in the shell's search path.
bool is_program(const std::string& name);

/// Output of a program, which is killed after `seconds`; "" if it does not exist.
std::string words_of(const std::vector<std::string>& command, double seconds);

}  // namespace treefarm
