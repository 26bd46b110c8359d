// SPDX-License-Identifier: Apache-2.0
#include "common/base/connection_limits.h"

#include <sys/resource.h>

#include <algorithm>

namespace treefarm {

bool is_kept_for_files(int descriptor) {
    constexpr rlim_t kKept = 16;
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return false;
    return static_cast<rlim_t>(descriptor) + kKept >= limit.rlim_cur;
}

std::size_t connection_to_close(std::span<const std::string> addresses) {
    std::size_t found = 0;
    std::ptrdiff_t most = 0;
    for (std::size_t k = 0; k < addresses.size(); ++k) {
        const std::ptrdiff_t count = std::count(addresses.begin(), addresses.end(), addresses[k]);
        if (count <= most) continue;
        most = count;
        found = k;
    }
    return found;
}

}  // namespace treefarm
