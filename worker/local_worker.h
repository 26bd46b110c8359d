// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "common/base/log.h"
#include "worker/worker_loop.h"

namespace treefarm {

/// Settings of a worker on this host. `threads`: 0: as many as processors.
WorkerSettings worker_here(unsigned threads, std::uint64_t fingerprint);

/// A worker in the coordinator's process, which is at the other end of the channel, until it is dismissed.
/// `threads`: 0: as many as processors. Errors are logged, and the coordinator notices the silence.
void run_local_worker(Channel& own, unsigned threads, std::uint64_t fingerprint, const Log& log);

}  // namespace treefarm
