// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Source that this program was built from: `git describe --always --dirty`, or "release" without a repository.
const char* build_source();

/// How it was built: kind of build, instruction set, sanitizer, effects that were left out.
const char* build_options();

}  // namespace treefarm
