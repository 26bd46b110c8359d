// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Page with its style and script: watch.html with watch.css and watch.js inlined. A response replaces "@NONCE@" by its
/// nonce.
extern const char* const kWatchPage;

}  // namespace treefarm
