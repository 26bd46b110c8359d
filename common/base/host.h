// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace treefarm {

/// This machine's name.
std::string host_name();

/// The machine that a process runs on.
struct Host {
    std::string name;
    std::uint64_t available_bytes = 0;  ///< memory that can still be had here; 0: not known
};

/// This machine, now. Memory is what the kernel says is available, or what is left of a control group's limit if that
/// is less: in a container or a Slurm job the group is what ends a process.
Host this_host();

/// Processors that this process may run on.
unsigned affinity_threads();

/// Processors of this host.
unsigned host_processors();

/// The processor's name in /proc/cpuinfo; "" where it has none.
std::string processor_name();

}  // namespace treefarm
