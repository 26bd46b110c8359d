// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/launched_command.h"

#include <algorithm>

namespace treefarm {

std::vector<std::string> LaunchedCommand::again(bool has_checkpoint) const {
    if (kind != Kind::render || goes_on) return words;
    if (has_checkpoint) {
        const bool like_option = folder.string().starts_with('-');
        std::vector<std::string> resume = {"resume", (like_option ? "." / folder : folder).string()};
        resume.insert(resume.end(), farm_options.begin(), farm_options.end());
        return resume;
    }
    std::vector<std::string> anew = words;
    // Files in the folder are of the attempt's own beginning.
    if (std::find(words.begin(), words.end(), "--overwrite") == words.end()) anew.emplace_back("--overwrite");
    return anew;
}

}  // namespace treefarm
