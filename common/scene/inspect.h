#pragma once

#include <string>
#include <vector>

#include "common/scene/finding.h"
#include "common/scene/scene.h"

namespace treefarm {

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
