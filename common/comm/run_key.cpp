// SPDX-License-Identifier: Apache-2.0
#include "common/comm/run_key.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/comm/private_file.h"

namespace treefarm {

void write_run_key(const std::filesystem::path& path) {
    const JoinKey key = draw_join_key();
    write_private_file(path, std::string(key.begin(), key.end()));
}

JoinKey read_run_key(const std::filesystem::path& path) {
    constexpr const char* kCure = "put the run directory on a disk that all hosts share";
    JoinKey key;
    const std::string bytes = read_private_file(path, key.size() + 1, kCure);
    if (bytes.size() != key.size()) throw InputError(Location{path.string(), 0, 0}, "is no key", kCure);
    std::copy(bytes.begin(), bytes.end(), key.begin());
    return key;
}

}  // namespace treefarm
