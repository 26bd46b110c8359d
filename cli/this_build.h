// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/protocol/fingerprint.h"

namespace treefarm {

/// The fingerprint of this program, complete: with what it was built from, and with which Embree it runs. Of the
/// calling thread.
Fingerprint this_build();

}  // namespace treefarm
