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
    unsigned threads = 1;  ///< that trace, besides the one that talks
    std::string host;
    std::uint64_t fingerprint = 0;
    double silence_seconds = 30.0;          ///< a coordinator silent for so long is gone
    std::uint64_t memory = 0;               ///< bytes that the host can still give; 0: not known
    std::function<bool()> told_to_leave{};  ///< asked often; true: this worker has to go. Empty: it never has
};

/// How a worker's part ended.
enum class WorkerEnd : std::uint8_t {
    orderly,     ///< told to leave, nobody was lost
    disorderly,  ///< told to leave, somebody was lost: do not wait for the others
    orphaned,    ///< the coordinator fell silent
};

/// A worker from hello to leave: receives scene and trees, traces what it is given, sends what is finished. The calling
/// thread is the one that talks; heartbeats go on while the others trace, build and learn.
WorkerEnd run_worker(Channel& channel, const WorkerSettings& settings, const MakeRenderer& make_renderer,
                     const Log& log);

}  // namespace treefarm
