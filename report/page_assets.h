// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// page.css and viewer.js, as they stand beside this file.
extern const char* const kPageStyle;
extern const char* const kViewerScript;

}  // namespace treefarm
