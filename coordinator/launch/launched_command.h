// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace treefarm {

/// Command that treefarm launch supervises.
struct LaunchedCommand {
    enum class Kind { render, resume, shot, study };
    Kind kind = Kind::render;
    std::vector<std::string> words;         ///< as typed: "render", "room.xml", "--spp", "64"
    std::filesystem::path folder;           ///< folder of the results; empty: a render without one
    std::string scene;                      ///< scene of a render, for the name of a folder
    std::vector<std::string> farm_options;  ///< options among them that a resume takes, too
    bool goes_on = false;                   ///< the words resume by themselves

    /// Words of the first attempt, and of one after an attempt that died before it owned the folder.
    std::vector<std::string> first() const { return words; }
    /// Words of a further attempt, after one that owned the folder, and has left a checkpoint or not.
    std::vector<std::string> again(bool has_checkpoint) const;
};

}  // namespace treefarm
