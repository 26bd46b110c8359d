// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/comm/channel.h"
#include "common/comm/join_ticket.h"

namespace treefarm {

/// The message-passing layer of this process, from MPI_Init to its end. After the start only point-to-point messages
/// are used, and nothing blocks on a peer, since Open MPI does not report dead peers (docs/design/protocol.md, "on
/// MPI").
class MpiSession {
  public:
    /// Starts MPI for one communicating thread; its errors become RunError with the call and the peer. MPI_Init waits
    /// for every process of the job, forever if one has died: if not all have come after `patience` seconds,
    /// `complaint` goes to standard error and the process ends with code 1. `secret`: of the run, if this process has
    /// it. If all processes have it, messages are sealed (SealedChannel).
    MpiSession(double patience, const std::string& complaint, const std::optional<JoinKey>& secret = std::nullopt);
    /// Does not finalise MPI: a process that unwinds must not wait for its peers in MPI_Finalize.
    ~MpiSession();
    MpiSession(const MpiSession&) = delete;
    MpiSession& operator=(const MpiSession&) = delete;

    int rank() const;
    int size() const;
    /// Number of ranks other than 0 on this host.
    int workers_on_host() const;
    /// Whether every process had the secret.
    bool is_sealed() const;
    Channel& channel();

    /// Ends the process's part in the job. `orderly`: no peer was lost, so MPI_Finalize can be waited for. If messages
    /// have not left, or MPI_Finalize has not returned, after `patience` seconds, the process ends at once with
    /// `exit_code`. Returns only after MPI_Finalize.
    void finish(bool orderly, int exit_code, double patience);

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace treefarm
