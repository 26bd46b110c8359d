// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/base/error.h"

namespace treefarm {

/// Something in a scene that is risky: it cannot be rendered, or will hardly look as it was meant to, or costs more
/// than it need.
struct Finding {
    enum class Severity : std::uint8_t {
        error,    ///< a render refuses it
        warning,  ///< the image suffers, or something is left out
        note,     ///< worth knowing
    };

    Severity severity = Severity::warning;
    std::string kind;  ///< one of a fixed list, for programs: "degenerate triangles" (docs/use/scenes.md)
    Location where;
    std::string what;  ///< what is wrong
    std::string cure;  ///< what to do; may be empty

    /// One line: "file:line:col: severity: what; cure".
    std::string text() const;
};

const char* name_of(Finding::Severity severity);

}  // namespace treefarm
