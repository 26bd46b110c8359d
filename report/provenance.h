// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace treefarm {

struct CellResult;

/// Origin of a render: place, time and program. Members are empty or 0 if its summary.json lacks them.
struct Provenance {
    std::string source;     ///< source version of the program, as git describes it
    std::string host;       ///< of the coordinator
    std::string processor;  ///< of that host
    std::string started;    ///< UTC, "2026-11-25 21:22"
    int workers = 0;
    int threads = 0;  ///< of all workers
};

/// Provenance of the render in a run directory.
Provenance read_provenance(const std::filesystem::path& folder);

/// "Rendered by treefarm COMMIT on HOST (PROCESSOR), from ... to ..., by 2 workers with 2 threads."
std::string provenance_text(std::span<const CellResult> cells);

}  // namespace treefarm
