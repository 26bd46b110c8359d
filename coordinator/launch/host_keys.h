// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "coordinator/launch/host_pool.h"

namespace treefarm {

/// Prefix of the files with an attempt's key on hosts; the attempt's name follows.
inline constexpr const char* kHostKeyName = "treefarm-key-";

/// File with an attempt's key on a host that does not share the run directory: in its folder for temporary files.
std::filesystem::path host_key_file(const std::string& attempt);

/// An attempt's key on other hosts: a file readable by this user alone, sent through ssh's standard input, never on a
/// command line. A host that cannot be reached has none (its processes look into the run directory, too). The files are
/// removed by the destructor.
class HostKeys {
  public:
    HostKeys(const std::vector<HostLine>& hosts, const std::filesystem::path& key, const std::string& attempt);
    ~HostKeys();
    HostKeys(const HostKeys&) = delete;
    HostKeys& operator=(const HostKeys&) = delete;

  private:
    const std::vector<HostLine> hosts_;
    const std::string attempt_;
};

}  // namespace treefarm
