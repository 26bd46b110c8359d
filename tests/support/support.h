// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm::test {

/// Path of a scene of ../shared/scenes, or empty when that folder is absent (the test then skips with a clear message).
std::string shared_scene(const std::string& relative);

/// Path of a scene of configs/scenes.
std::string own_scene(const std::string& relative);

}  // namespace treefarm::test
