// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "coordinator/launch/host_pool.h"

namespace treefarm {

/// Hosts where a line of shell does not end well within `seconds`, by ssh or by the agent that Open MPI is told to use
/// (OMPI_MCA_plm_rsh_agent). All are asked side by side; this host is not asked. `input`: a file that the line can
/// read, or empty.
std::set<std::string> failing_hosts(const std::vector<HostLine>& hosts, const std::string& line, double seconds,
                                    const std::filesystem::path& input = {});

/// Hosts that do not answer.
std::set<std::string> unreachable_hosts(const std::vector<HostLine>& hosts);

/// Whether a program is found where the shell would find it.
bool is_program(const std::string& name);

/// What a program prints, killed after `seconds`; "" where it is not there.
std::string words_of(const std::vector<std::string>& command, double seconds);

}  // namespace treefarm
