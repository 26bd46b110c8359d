// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "common/base/error.h"

namespace treefarm {

/// A risk in a scene: it cannot be rendered, will hardly look as intended, or costs more than necessary.
struct Finding {
    enum class Severity : std::uint8_t {
        error,    ///< a render refuses it
        warning,  ///< the image suffers, or something is left out
        note,     ///< worth knowing
    };

    Severity severity = Severity::warning;
    std::string kind;  ///< one of a fixed list, for programs: "degenerate triangles" (docs/use/scenes.md)
    Location where;
    std::string what;  ///< the fault
    std::string cure;  ///< the cure; may be empty

    /// One line: "file:line:col: severity: what; cure".
    std::string text() const;
    /// text() without the severity, for where that is said already.
    std::string sentence() const;
};

const char* name_of(Finding::Severity severity);

}  // namespace treefarm
