// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace treefarm {

/// Source version of this program: `git describe --always --dirty`, or "release" without a repository.
const char* build_source();

/// Build configuration: kind of build, instruction set, sanitizer, omitted effects.
const char* build_options();

}  // namespace treefarm
