// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/base/error.h"

namespace treefarm::mitsuba {

/// Where the names of files in a scene lead: to the folders of its <path> elements, the last one first, then to the
/// scene's own folder, then to the folder of the included file in which the name stands. Mitsuba looks in the first
/// two (FileResolver) and, like it, a second look ignores the case of letters and takes "\" for "/": many scenes
/// were written on other systems.
class FileSearch {
  public:
    explicit FileSearch(std::filesystem::path scene_folder) { folders_.push_back(std::move(scene_folder)); }

    /// A <path>, relative to the folder of the file in which it stands; InputError if there is no such folder.
    void add(const std::string& name, const std::filesystem::path& own_folder, const Location& where);

    /// The first file of that name, or `own_folder / name` if there is none.
    std::filesystem::path find(const std::string& name, const std::filesystem::path& own_folder) const;

  private:
    std::vector<std::filesystem::path> folders_;
};

}  // namespace treefarm::mitsuba
