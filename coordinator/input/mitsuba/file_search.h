// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/error.h"

namespace treefarm::mitsuba {

/// Search path of file names in a scene: the folders of its <path> elements, the last one first, then the scene's own
/// folder, then the folder of the included file that has the name. Mitsuba searches the first two (FileResolver). As in
/// Mitsuba, a second search ignores the case of letters and reads "\" as "/", since many scenes were written on other
/// systems.
class FileSearch {
  public:
    explicit FileSearch(std::filesystem::path scene_folder) { folders_.push_back(std::move(scene_folder)); }

    /// Adds a <path>, relative to the folder of its file. Throws InputError if the folder does not exist.
    void add(const std::string& name, const std::filesystem::path& own_folder, const Location& where);

    /// The first file of this name, or `own_folder / name` if there is none.
    std::filesystem::path find(const std::string& name, const std::filesystem::path& own_folder) const;

  private:
    std::vector<std::filesystem::path> folders_;
};

}  // namespace treefarm::mitsuba
