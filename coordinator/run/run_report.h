// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ctime>
#include <string>
#include <vector>

#include "common/config/job.h"
#include "common/plan/effects/approximation.h"
#include "common/protocol/fingerprint.h"
#include "coordinator/farm/farm.h"
#include "coordinator/passes/pass_loop.h"

namespace treefarm {

/// State of a run.
enum class RunState : std::uint8_t { running, done, interrupted, failed };

/// Facts about a run, for its files.
struct RunFacts {
    std::string command;           ///< command that started it
    std::uint64_t scene_hash = 0;  ///< content_hash() of the packed scene
    Fingerprint fingerprint;
    std::vector<Approximation> approximations;
    CropWindow crop{};                 ///< of the image, if it is a crop window
    std::vector<PassPlan> schedule{};  ///< --schedule: these passes; empty: the job's own
    std::string attempt{};             ///< attempt of treefarm launch; "" without launch
};

/// Result of a run.
struct RunEnd {
    RunState state = RunState::failed;
    std::string error;  ///< "" without an error
    double elapsed_seconds = 0;
    std::string tree_file_hash;  ///< of tree.bin; "" without one
};

/// Contents of status.json and summary.json. Invalid UTF-8 in names of files and hosts is replaced. `farm`: source of
/// the workers' figures; `last_pass`: the last finished pass, with its forecasts. Either may be nullptr.
std::string status_json(const RunFacts& facts, const RenderProgress& progress, double elapsed_seconds,
                        const Farm* farm = nullptr, const PassReport* last_pass = nullptr);
/// Content of status.json before the first pass, and after the last one.
std::string status_json(const RunFacts& facts, RunState state, std::uint32_t spp_done, double elapsed_seconds);
std::string summary_json(const Job& job, const RunFacts& facts, const RenderResult& result, const Farm* farm,
                         const RunEnd& end);

}  // namespace treefarm
