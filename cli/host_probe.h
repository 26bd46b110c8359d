// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

#include "coordinator/launch/host_pool.h"

namespace treefarm {

/// Hosts where a command cannot be started within some seconds by ssh, or by the agent that Open MPI is told to use
/// (OMPI_MCA_plm_rsh_agent). All are asked side by side; this host is not asked.
std::set<std::string> unreachable_hosts(const std::vector<HostLine>& hosts);

/// Whether a program is found where the shell would find it.
bool is_program(const std::string& name);

/// What a program prints, killed after `seconds`; "" where it is not there.
std::string words_of(const std::vector<std::string>& command, double seconds);

}  // namespace treefarm
