// SPDX-License-Identifier: Apache-2.0
// Loss of workers: silence, how long the farm waits for one to come back, and what the last message says.
#include <spdlog/fmt/fmt.h>

#include "common/base/text/duration_text.h"
#include "coordinator/farm/farm.h"

namespace treefarm {

void Farm::watch_for_silence() {
    const double now = clock_.seconds();
    for (Member* member : roster_.overdue(now))
        give_up(*member, MemberState::lost, "was silent for too long");
    for (Member* member : roster_.present())
        if (!channel_.is_open(member->peer)) give_up(*member, MemberState::lost, "closed its connection");
    if (!scene_sent_ || roster_.present_count() > 0) {
        alone_since_.reset();
        return;
    }
    const bool wait = may_come_back();
    if (wait && !alone_since_) {
        alone_since_ = now;
        log_->warn("no worker answers: waiting {} for one to come back", limit_text(limits_.grace));
    }
    if (wait && now - *alone_since_ <= limits_.grace) return;
    if (longest_silence_ <= limits_.heard) throw NoWorkerLeft("no worker is left" + why_nobody(), false);
    throw NoWorkerLeft(fmt::format("no worker is left: this process was stopped for {:.0f} s, and they left meanwhile",
                                   longest_silence_),
                       true);
}

/// Description of a unit, with the command that traces it alone.
std::string Farm::blame(const WorkUnit& unit) const {
    const std::string pass = std::to_string(unit.pass + 1), of_pass = " of pass " + pass;
    if (unit.kind != UnitKind::tile)
        return "work " + std::to_string(unit.first) + " to " + std::to_string(unit.first + unit.count) + of_pass;
    std::string name = pass;
    for (const std::uint32_t number :
         {std::uint32_t{unit.x0}, std::uint32_t{unit.y0}, std::uint32_t{unit.x1}, std::uint32_t{unit.y1}, unit.chunk})
        name += "," + std::to_string(number);
    return "the pixels from " + std::to_string(unit.x0) + "," + std::to_string(unit.y0) + " to below " +
           std::to_string(unit.x1) + "," + std::to_string(unit.y1) + of_pass +
           "; to trace them alone: " + debug_command_ + " " + name + debug_options_;
}

/// Cause of the loss of the last workers, as far as known.
std::string Farm::why_nobody() const {
    if (!last_failure_.empty()) return ": " + last_failure_;
    const auto [unit, deaths] = worst_poison_unit();
    return deaths < 2 ? "" : ": " + std::to_string(deaths) + " were lost over " + blame(unit);
}

std::pair<WorkUnit, std::size_t> Farm::worst_poison_unit() const {
    return ledger_ ? ledger_->worst_poison_unit() : std::pair<WorkUnit, std::size_t>();
}

bool Farm::may_come_back() const {
    if (channel_.takes_guests()) return true;
    for (const int peer : channel_.peers()) {
        const auto found = roster_.members().find(peer);
        const bool unknown = found == roster_.members().end();
        if (unknown ? !turn_.absent.contains(peer) && !turn_.left.contains(peer)
                    : found->second.state == MemberState::lost)
            return true;
    }
    return false;
}

}  // namespace treefarm
