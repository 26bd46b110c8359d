// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

/// Kind of a folder's content, among those that this program writes.
enum class FolderContent {
    nothing,
    render,  ///< a run directory
    study,   ///< written by treefarm study
    shot,    ///< written by treefarm render --frames, or frames that were rendered one by one
    other    ///< none of these
};
FolderContent folder_content(const std::filesystem::path& folder);

/// Subfolder name of an earlier run that was set aside: "previous", "previous-2", ... by number from 1.
std::string previous_name(int number);
/// Earlier runs that were set aside in a folder.
std::vector<std::filesystem::path> previous_runs(const std::filesystem::path& folder);

/// Content of a run directory, for a message: "done, 64 spp", "broken off, 12 spp".
std::string render_words(const std::filesystem::path& folder);

/// Author of the folder's status.json: "process 12 on node3"; "" if unknown.
std::string writer_words(const std::filesystem::path& folder);

}  // namespace treefarm
