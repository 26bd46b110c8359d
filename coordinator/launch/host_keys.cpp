// SPDX-License-Identifier: Apache-2.0
#include "coordinator/launch/host_keys.h"

#include "coordinator/launch/host_probe.h"
#include "coordinator/launch/sweep.h"

namespace treefarm {

namespace {

/// For a host to write a file, and to remove it: one that is gone must not hold up a restart.
constexpr double kSendSeconds = 10.0, kTakeBackSeconds = 3.0;

/// As host_key_file(), for the host's shell.
std::string file_there(const std::string& attempt) {
    return "\"${TMPDIR:-/tmp}\"/" + (kHostKeyName + attempt);
}

}  // namespace

std::filesystem::path host_key_file(const std::string& attempt) {
    return temporary_folder() / (kHostKeyName + attempt);
}

HostKeys::HostKeys(const std::vector<HostLine>& hosts, const std::filesystem::path& key, const std::string& attempt)
    : hosts_(hosts), attempt_(attempt) {
    // -C: a file that somebody has put there is not written to.
    failing_hosts(hosts_, "umask 077; set -C; cat > " + file_there(attempt_), kSendSeconds, key);
}

HostKeys::~HostKeys() {
    try {
        failing_hosts(hosts_, "rm -f " + file_there(attempt_), kTakeBackSeconds);
    } catch (const std::exception&) {  // it is of no use to anybody any more
    }
}

}  // namespace treefarm
