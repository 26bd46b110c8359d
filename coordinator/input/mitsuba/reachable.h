// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "coordinator/input/mitsuba/scene_document.h"

namespace treefarm::mitsuba {

/// Whether an element only says what something is, for others to refer to: at a scene's top it does nothing by itself.
bool is_definition(const XmlElement& element);

/// The objects that the scene is made of: what stands at its top and is no definition, and all that this refers to,
/// directly or through others. The rest has no influence on the image.
std::set<const XmlElement*> reachable_objects(const SceneDocument& document);

}  // namespace treefarm::mitsuba
