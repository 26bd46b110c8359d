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
    lost,     ///< was silent for too long: what it still sends is dropped
    refused,  ///< never took part
    left,     ///< said good-bye
    barred,   ///< said what was wrong, or that it cannot go on: it may not come back to this job
};

/// One life of one worker process.
struct Member {
    int peer = 0;
    Hello hello;
    MemberState state = MemberState::present;
    double last_heard = 0;           ///< seconds of the coordinator's clock
    std::uint32_t credit = 0;        ///< units that it asked for and has not got
    bool asked_back = false;         ///< a lost one that spoke again was told to rejoin
    std::uint32_t lives = 0;         ///< of this peer, with this one
    std::uint32_t bad_messages = 0;  ///< of all its lives, that were refused
    Heartbeat progress;              ///< the last one
    WorkerSpeed speed;               ///< by all of them
    std::uint64_t queued = 0;        ///< paths that it has to begin, as far as is known
    bool told_end = false;           ///< that nothing of the pass is left to hand out
};

/// Who is there, by peer and incarnation. Open MPI tells nobody about dead processes, so silence is the only sign.
class Roster {
  public:
    /// `lost_seconds`: how long a worker may be silent.
    explicit Roster(double lost_seconds) : lost_seconds_(lost_seconds) {}

    /// A worker said hello. A peer that was known under another incarnation is a new life: the old one must have been
    /// given up by the caller before.
    Member& admit(int peer, const Hello& hello, double now);

    /// The member that speaks, if it is present under this incarnation; notes that it lives.
    Member* hear(int peer, std::uint64_t incarnation, double now);

    /// Excuses everybody's silence for so long as nobody could have been heard.
    void excuse(double seconds);

    Member* find(int peer);
    /// Members silent for too long at `now`, not yet marked.
    std::vector<Member*> overdue(double now);
    /// Members that take part, by peer.
    std::vector<Member*> present();
    std::size_t present_count() const;
    /// Threads of all members present.
    std::uint64_t thread_count() const;
    const std::map<int, Member>& members() const { return members_; }

  private:
    double lost_seconds_;
    std::map<int, Member> members_;
};

}  // namespace treefarm
