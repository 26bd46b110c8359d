// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/roster.h"

#include <algorithm>

namespace treefarm {

Member& Roster::admit(int peer, const Hello& hello, double now) {
    Member& member = members_[peer];
    const Member before = member;
    member = Member{};
    member.lives = before.lives + 1;
    member.bad_messages = before.bad_messages;
    member.peer = peer;
    member.hello = hello;
    member.last_heard = now;
    return member;
}

Member* Roster::hear(int peer, std::uint64_t incarnation, double now) {
    Member* member = find(peer);
    if (!member || member->state != MemberState::present || member->hello.incarnation != incarnation) return nullptr;
    member->last_heard = now;
    return member;
}

void Roster::excuse(double seconds) {
    for (Member* member : present())
        member->last_heard += seconds;
}

Member* Roster::find(int peer) {
    const auto found = members_.find(peer);
    return found == members_.end() ? nullptr : &found->second;
}

std::vector<Member*> Roster::overdue(double now) {
    std::vector<Member*> silent;
    for (Member* member : present())
        if (now - member->last_heard > lost_seconds_) silent.push_back(member);
    return silent;
}

std::vector<Member*> Roster::present() {
    std::vector<Member*> found;
    for (auto& [peer, member] : members_)
        if (member.state == MemberState::present) found.push_back(&member);
    return found;
}

std::size_t Roster::present_count() const {
    return static_cast<std::size_t>(std::count_if(
        members_.begin(), members_.end(), [](const auto& m) { return m.second.state == MemberState::present; }));
}

std::uint64_t Roster::thread_count() const {
    std::uint64_t threads = 0;
    for (const auto& [peer, member] : members_)
        if (member.state == MemberState::present) threads += member.hello.threads;
    return threads;
}

}  // namespace treefarm
