// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/comm/channel.h"
#include "common/comm/join_ticket.h"

namespace treefarm {

/// The message-passing layer of this process, from MPI_Init to its end. Only point-to-point messages are used after the
/// start, and nothing ever blocks on a peer: Open MPI does not report a dead one (docs/design/protocol.md, "on MPI").
class MpiSession {
  public:
    /// Starts MPI for one talking thread; its errors come back as RunError with the call and the peer in the message.
    /// MPI waits for every process of the job here, and for ever for one that died or left: where they have not all
    /// come after `patience` seconds, `complaint` goes to standard error and the process leaves with code 1.
    /// `secret`: of the run, where this process has it. Where all have it their messages are sealed (SealedChannel).
    MpiSession(double patience, const std::string& complaint, const std::optional<JoinKey>& secret = std::nullopt);
    /// Does nothing to MPI: a process that is unwinding must not wait for its peers in MPI_Finalize.
    ~MpiSession();
    MpiSession(const MpiSession&) = delete;
    MpiSession& operator=(const MpiSession&) = delete;

    int rank() const;
    int size() const;
    /// Ranks other than 0 on this host.
    int workers_on_host() const;
    /// Whether every process had the secret.
    bool is_sealed() const;
    Channel& channel();

    /// Ends the process's part in the job. `orderly`: no peer was lost, so MPI_Finalize can be waited for; this is
    /// still given up, and the process left at once with `exit_code`, if messages are not drained or MPI_Finalize has
    /// not returned after `patience` seconds. Returns only after MPI_Finalize.
    void finish(bool orderly, int exit_code, double patience);

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace treefarm
