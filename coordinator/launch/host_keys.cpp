// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/host_keys.h"

#include "coordinator/launch/host_probe.h"
#include "coordinator/launch/sweep.h"

namespace treefarm {

namespace {

/// Time limits for a host to write a key file, and to remove it: a lost host must not hold up a restart.
constexpr double kSendSeconds = 10.0, kTakeBackSeconds = 3.0;

/// Path of host_key_file() in the syntax of the host's shell.
std::string file_there(const std::string& attempt) {
    return "\"${TMPDIR:-/tmp}\"/" + (kHostKeyName + attempt);
}

}  // namespace

std::filesystem::path host_key_file(const std::string& attempt) {
    return temporary_folder() / (kHostKeyName + attempt);
}

HostKeys::HostKeys(const std::vector<HostLine>& hosts, const std::filesystem::path& key, const std::string& attempt)
    : hosts_(hosts), attempt_(attempt) {
    // -C: an existing file of another user is not written to.
    failing_hosts(hosts_, "umask 077; set -C; cat > " + file_there(attempt_), kSendSeconds, key);
}

HostKeys::~HostKeys() {
    try {
        failing_hosts(hosts_, "rm -f " + file_there(attempt_), kTakeBackSeconds);
    } catch (const std::exception&) {  // the key is useless after the attempt
    }
}

}  // namespace treefarm
