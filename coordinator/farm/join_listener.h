// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "common/base/log.h"
#include "common/comm/channel.h"
#include "common/config/job.h"

namespace treefarm {

/// Entry point for guest workers: a channel that lets them join a running render, and the ticket in the run directory,
/// which is removed at the end. Guests that have joined stay.
class JoinListener {
  public:
    /// Opens the entry point if the job asks for it. `fingerprint`: required of guests. Throws InputError if the job's
    /// address cannot be listened on, and RunError if the ticket cannot be written.
    JoinListener(Channel& channel, const Job::Farm& farm, std::uint64_t fingerprint, const std::filesystem::path& run,
                 const Log& log);
    ~JoinListener();
    JoinListener(const JoinListener&) = delete;
    JoinListener& operator=(const JoinListener&) = delete;

  private:
    std::filesystem::path ticket_;  ///< empty: none
};

}  // namespace treefarm
