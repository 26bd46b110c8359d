// SPDX-License-Identifier: Apache-2.0
#include "cli/this_build.h"

#include "cli/build_info.h"
#include "worker/geometry/embree_version.h"

namespace treefarm {

Fingerprint this_build() {
    return own_fingerprint(build_source(), build_options(), embree_version());
}

}  // namespace treefarm
