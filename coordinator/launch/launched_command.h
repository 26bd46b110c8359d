// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

/// The command that treefarm launch keeps alive.
struct LaunchedCommand {
    enum class Kind { render, resume, shot, study };
    Kind kind = Kind::render;
    std::vector<std::string> words;         ///< as typed: "render", "room.xml", "--spp", "64"
    std::filesystem::path folder;           ///< where results go; empty: a render that names none
    std::string scene;                      ///< of a render, for the name of a folder
    std::vector<std::string> farm_options;  ///< of the words, what a resume takes, too
    bool goes_on = false;                   ///< the words themselves go on with what is there

    /// Words of the first attempt, and of one that follows an attempt that died before it had the folder.
    std::vector<std::string> first() const { return words; }
    /// Words of a further attempt, where an earlier one had the folder, and has left a checkpoint there or not.
    std::vector<std::string> again(bool has_checkpoint) const;
};

}  // namespace treefarm
