// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "coordinator/input/mitsuba/scene_document.h"

namespace treefarm::mitsuba {

/// Whether an element only defines an object for references: at a scene's top level it has no effect.
bool is_definition(const XmlElement& element);

/// Objects that the scene consists of: those at its top level that are no definitions, and all that they refer to,
/// directly or indirectly. The others do not influence the image.
std::set<const XmlElement*> reachable_objects(const SceneDocument& document);

}  // namespace treefarm::mitsuba
