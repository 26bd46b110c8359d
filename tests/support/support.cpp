// SPDX-License-Identifier: Apache-2.0
#include "tests/support/support.h"

#include <filesystem>

namespace treefarm::test {

std::string shared_scene(const std::string& relative) {
    const std::filesystem::path path =
        std::filesystem::path(TREEFARM_SOURCE_DIR).parent_path() / "shared" / "scenes" / relative;
    return std::filesystem::exists(path) ? path.string() : std::string();
}

std::string own_scene(const std::string& relative) {
    return std::string(TREEFARM_SOURCE_DIR) + "/configs/scenes/" + relative;
}

}  // namespace treefarm::test
