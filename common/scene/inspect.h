#pragma once

#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/scene/scene.h"

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
    std::string kind;  ///< one of a fixed list, for programs: "degenerate triangles" (docs/scenes.md)
    Location where;
    std::string what;  ///< what is wrong
    std::string cure;  ///< what to do; may be empty

    /// One line: "file:line:col: severity: what; cure".
    std::string text() const;
};

const char* name_of(Finding::Severity severity);

/// Looks at a scene as its reader left it, before validate_scene() repairs or refuses it. Pure; any scene whose indices
/// exist is accepted. Findings come by shape, material, emitter, and what concerns the whole.
std::vector<Finding> inspect(const Scene& scene);

namespace inspection {

/// The parts of inspect().
void inspect_shapes(const Scene& scene, std::vector<Finding>& findings);
void inspect_materials(const Scene& scene, std::vector<Finding>& findings);
void inspect_emitters(const Scene& scene, std::vector<Finding>& findings);
void inspect_scale(const Scene& scene, std::vector<Finding>& findings);

/// "the shape", or with its name.
std::string named(const std::string& kind, const std::string& name);
/// A number as people write it.
std::string short_number(double value);

}  // namespace inspection

}  // namespace treefarm
