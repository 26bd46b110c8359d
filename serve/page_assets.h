// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// The page with its style and script: watch.html with watch.css and watch.js inside. "@NONCE@" stands where a response
/// puts its nonce.
extern const char* const kWatchPage;

}  // namespace treefarm
