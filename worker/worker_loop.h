// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "common/base/log.h"
#include "common/comm/channel.h"
#include "worker/integrators/contract.h"

namespace treefarm {

struct WorkerSettings {
    unsigned threads = 1;  ///< tracing threads, besides the communication thread
    std::string host;
    std::uint64_t fingerprint = 0;
    double silence_seconds = 30.0;          ///< silence after which the coordinator counts as lost
    std::uint64_t memory = 0;               ///< free memory of the host in bytes; 0: unknown
    std::function<bool()> told_to_leave{};  ///< polled often; true: this worker has to leave. Empty: never
};

/// Way in which a worker ended.
enum class WorkerEnd : std::uint8_t {
    orderly,     ///< told to leave, no worker was lost
    disorderly,  ///< told to leave, a worker was lost: do not wait for the others
    orphaned,    ///< the coordinator fell silent
};

/// Runs a worker from its Hello to its Leave: receives scene and trees, traces its units, sends results. The calling
/// thread communicates; heartbeats continue while the others trace, build and learn.
WorkerEnd run_worker(Channel& channel, const WorkerSettings& settings, const MakeRenderer& make_renderer,
                     const Log& log);

}  // namespace treefarm
