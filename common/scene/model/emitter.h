// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/base/error.h"
#include "common/scene/kinds/emitters.h"

namespace treefarm {

struct Emitter {
    EmitterKind kind;
    Location where;

    const EmitterTraits& traits() const {
        return std::visit([](const auto& held) -> const EmitterTraits& { return held.kTraits; }, kind);
    }
    LightType type() const { return traits().type; }
};

}  // namespace treefarm
