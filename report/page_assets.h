// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Contents of page.css and viewer.js in this folder.
extern const char* const kPageStyle;
extern const char* const kViewerScript;

}  // namespace treefarm
