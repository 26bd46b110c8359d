// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "common/guiding/any_guide.h"
#include "coordinator/render/read_request.h"

namespace treefarm {

/// A finished run, read from its directory.
struct InspectedRun {
    std::filesystem::path directory;
    RenderRequest request;  ///< job and scene, read again
    AnyModel tree;
    std::uint64_t tree_bytes = 0;       ///< of tree.bin
    bool taught_by_next_event = false;  ///< the last pass that taught the tree sampled emitters
};

/// Reads job.toml, summary.json, schedule.toml and tree.bin of a run directory, and the scene again. Throws InputError
/// for a missing file, and for a tree or a scene that is not the run's.
InspectedRun read_inspected_run(const std::filesystem::path& directory);

}  // namespace treefarm
