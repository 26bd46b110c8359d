// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/scene/model/scene.h"
#include "coordinator/input/check/finding.h"

namespace treefarm {

/// Looks at a scene as its reader left it, before validate_scene() repairs or refuses it. Pure; any scene whose indices
/// exist is accepted. Findings come by shape, material, emitter, and what concerns the whole.
std::vector<Finding> lint(const Scene& scene);

/// Why an image of the scene may be black, as far as a few hundred rays tell: the camera sees backs of one-sided
/// surfaces only, or nothing, or is in a closed shape without light; an emitter's light ends at such backs, at a
/// surface right before it, or at smooth glass. Pure. lint() says these, too.
std::vector<Finding> dark_causes(const Scene& scene);

namespace linting {

/// The parts of lint().
void lint_shapes(const Scene& scene, std::vector<Finding>& findings);
void lint_materials(const Scene& scene, std::vector<Finding>& findings);
void lint_emitters(const Scene& scene, std::vector<Finding>& findings);
void lint_darkness(const Scene& scene, std::vector<Finding>& findings);
void lint_scale(const Scene& scene, std::vector<Finding>& findings);

/// "the shape", or with its name.
std::string named(const std::string& kind, const std::string& name);
/// A number as people write it.
std::string short_number(double value);

}  // namespace linting

}  // namespace treefarm
