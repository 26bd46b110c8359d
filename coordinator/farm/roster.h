// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "common/protocol/messages.h"
#include "coordinator/farm/speeds.h"

namespace treefarm {

enum class MemberState : std::uint8_t {
    present,  ///< takes part
    lost,     ///< was silent for too long: its messages are dropped
    refused,  ///< never took part
    left,     ///< said good-bye
    barred,   ///< sent an invalid message or reported a failure: it may not come back to this job
};

/// One incarnation of one worker process.
struct Member {
    int peer = 0;
    Hello hello;
    bool is_guest = false;  ///< it joined by itself: what it says of itself concerns nobody else
    MemberState state = MemberState::present;
    double last_heard = 0;           ///< time of the last message, in seconds of the coordinator's clock
    std::uint32_t credit = 0;        ///< units requested and not issued yet
    bool asked_back = false;         ///< a lost worker that sent again was told to rejoin
    std::uint32_t lives = 0;         ///< number of incarnations of this peer, this one included
    std::uint32_t bad_messages = 0;  ///< refused messages, of all its incarnations
    Heartbeat progress;              ///< last heartbeat
    WorkerSpeed speed;               ///< from all heartbeats
    std::uint64_t queued = 0;        ///< paths of its units that are not begun, as far as known
    bool told_end = false;           ///< it was told that no unit of the pass waits
};

/// Register of workers by peer and incarnation. Open MPI does not report dead processes, so silence is the only sign.
class Roster {
  public:
    /// `lost_seconds`: silence after which a worker counts as lost.
    explicit Roster(double lost_seconds) : lost_seconds_(lost_seconds) {}

    /// Admits a worker that said hello. For a peer known under another incarnation the caller must have given up the
    /// old one before.
    Member& admit(int peer, const Hello& hello, double now);

    /// Member that sent a message, if it is present under this incarnation; resets its silence.
    Member* hear(int peer, std::uint64_t incarnation, double now);

    /// Excuses `seconds` of silence of all members, in which no message could be received.
    void excuse(double seconds);

    Member* find(int peer);
    /// Members silent for too long at `now`, not yet marked.
    std::vector<Member*> overdue(double now);
    /// Members that take part, by peer.
    std::vector<Member*> present();
    std::size_t present_count() const;
    /// Sum of the present members' threads.
    std::uint64_t thread_count() const;
    const std::map<int, Member>& members() const { return members_; }

  private:
    double lost_seconds_;
    std::map<int, Member> members_;
};

}  // namespace treefarm
