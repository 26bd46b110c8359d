// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace treefarm {

/// Content of a folder, as far as this program wrote it.
enum class FolderContent {
    nothing,
    render,  ///< a run directory
    study,   ///< what treefarm study writes
    shot,    ///< what treefarm render --frames writes, or frames that were rendered one by one
    other    ///< none of ours
};
FolderContent folder_content(const std::filesystem::path& folder);

/// Names of the files that a render leaves in its folder.
std::span<const std::string_view> run_file_names();

/// Name of the place where an earlier run lies aside in its folder: "previous", "previous-2", ... by number from 1.
std::string previous_name(int number);
/// The runs that lie aside in a folder.
std::vector<std::filesystem::path> previous_runs(const std::filesystem::path& folder);

/// Content of a run directory, for a message: "done, 64 spp", "broken off, 12 spp".
std::string render_words(const std::filesystem::path& folder);

/// Who wrote the folder's status.json: "process 12 on node3"; "" if it does not say.
std::string writer_words(const std::filesystem::path& folder);

}  // namespace treefarm
