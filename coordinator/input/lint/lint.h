// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "common/scene/model/scene.h"
#include "coordinator/input/check/finding.h"

namespace treefarm {

/// Findings about a scene as its reader left it, before validate_scene() repairs or refuses it. Pure; the scene's
/// indices must exist. Ordered by shape, material and emitter, then those about the whole scene.
std::vector<Finding> lint(const Scene& scene);

/// Reasons why an image of the scene may be black, according to a few hundred rays: the camera sees only backs of
/// one-sided surfaces, or nothing, or is in a closed shape without light; an emitter's light ends at such backs, at a
/// surface directly in front of it, or at smooth glass. Pure. Included in lint().
std::vector<Finding> dark_causes(const Scene& scene);

namespace linting {

/// Parts of lint().
void lint_shapes(const Scene& scene, std::vector<Finding>& findings);
void lint_materials(const Scene& scene, std::vector<Finding>& findings);
void lint_emitters(const Scene& scene, std::vector<Finding>& findings);
void lint_darkness(const Scene& scene, std::vector<Finding>& findings);
void lint_scale(const Scene& scene, std::vector<Finding>& findings);

/// Text "the shape", or with its name.
std::string named(const std::string& kind, const std::string& name);
/// Number as short text.
std::string short_number(double value);

}  // namespace linting

}  // namespace treefarm
