// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm::test {

/// Path of a scene of ../shared/scenes, or empty if that folder is absent (the test is then skipped with a message).
std::string shared_scene(const std::string& relative);

/// Path of a scene of configs/scenes.
std::string own_scene(const std::string& relative);

}  // namespace treefarm::test
