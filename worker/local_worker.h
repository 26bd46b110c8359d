// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/base/log.h"
#include "worker/worker_loop.h"

namespace treefarm {

/// Settings of a worker on this host. `threads`: 0: one per processor.
WorkerSettings worker_here(unsigned threads, std::uint64_t fingerprint);

/// Runs a worker in the coordinator's process, which has the other end of the channel, until it is dismissed.
/// `threads`: 0: one per processor. Errors are logged; the coordinator notices the silence.
void run_local_worker(Channel& own, unsigned threads, std::uint64_t fingerprint, const Log& log);

}  // namespace treefarm
