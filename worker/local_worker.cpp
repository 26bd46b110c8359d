// SPDX-License-Identifier: Apache-2.0
#include "worker/local_worker.h"

#include <exception>

#include "common/base/host.h"
#include "worker/registry.h"

namespace treefarm {

WorkerSettings worker_here(unsigned threads, std::uint64_t fingerprint) {
    const Host host = this_host();
    return {.threads = threads > 0 ? threads : affinity_threads(),
            .host = host.name,
            .fingerprint = fingerprint,
            .memory = host.available_bytes};
}

void run_local_worker(Channel& own, unsigned threads, std::uint64_t fingerprint, const Log& log) {
    WorkerSettings settings = worker_here(threads, fingerprint);
    settings.silence_seconds = 1e9;  // a worker in the same process is never lost
    try {
        run_worker(own, settings, make_renderer, log);
    } catch (const std::exception& error) {
        log->error("{}", error.what());
    }
}

}  // namespace treefarm
