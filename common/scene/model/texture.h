// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/error.h"
#include "common/scene/kinds/textures.h"

namespace treefarm {

struct Texture {
    TextureKind kind;
    std::string name;
    Location where;
};

}  // namespace treefarm
