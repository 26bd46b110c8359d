// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Tables in Markdown of all kinds of shapes, materials, emitters and textures with their values and ranges, in packed
/// order, as their fields() name them: docs/generated/scene.md.
std::string kind_documentation();

}  // namespace treefarm
