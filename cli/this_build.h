// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/protocol/fingerprint.h"

namespace treefarm {

/// Complete fingerprint of this program: with its source version and the loaded Embree. Of the calling thread.
Fingerprint this_build();

}  // namespace treefarm
