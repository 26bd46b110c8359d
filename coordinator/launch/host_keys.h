// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "coordinator/launch/host_pool.h"

namespace treefarm {

/// How files with an attempt's secret begin, on hosts; the attempt's name follows.
inline constexpr const char* kHostKeyName = "treefarm-key-";

/// Where a host that does not see the run directory finds an attempt's secret: in its folder for temporary files.
std::filesystem::path host_key_file(const std::string& attempt);

/// An attempt's secret on other hosts: a file that this user alone can read, sent over ssh's standard input, never by a
/// command line. A host that cannot be told goes without (its processes look into the run directory, too). Taken back
/// when this is destroyed.
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
