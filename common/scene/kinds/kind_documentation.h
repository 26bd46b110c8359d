// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Markdown tables of all kinds of shapes, materials, emitters and textures, with values and ranges in packed order,
/// from their fields(): docs/generated/scene.md.
std::string kind_documentation();

}  // namespace treefarm
