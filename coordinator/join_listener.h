// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/base/log.h"
#include "common/comm/channel.h"
#include "common/config/job.h"

namespace treefarm {

/// The way for workers to join a running render: a channel that takes guests, and the ticket in the run directory,
/// which is removed at the end. Guests that are in stay.
class JoinListener {
  public:
    /// Opens it where the job says so. `fingerprint`: guests must have the same. Throws InputError where nobody can
    /// listen as the job says, RunError where the ticket cannot be written.
    JoinListener(Channel& channel, const Job::Farm& farm, std::uint64_t fingerprint, const std::filesystem::path& run,
                 const Log& log);
    ~JoinListener();
    JoinListener(const JoinListener&) = delete;
    JoinListener& operator=(const JoinListener&) = delete;

  private:
    std::filesystem::path ticket_;  ///< empty: none
};

}  // namespace treefarm
