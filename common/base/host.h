// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace treefarm {

/// Network name of this machine.
std::string host_name();

/// A machine and its free memory.
struct Host {
    std::string name;
    std::uint64_t available_bytes = 0;  ///< memory that a process here can still allocate; 0: unknown
};

/// Name and free memory of this machine. The memory is the kernel's figure, or the rest of a control group's limit if
/// that is less: in a container or a Slurm job the group limit ends a process.
Host this_host();

/// Processors that this process may run on.
unsigned affinity_threads();

/// Processors of this host.
unsigned host_processors();

/// Model name of the processor from /proc/cpuinfo; "" if it gives none.
std::string processor_name();

}  // namespace treefarm
