// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/join_listener.h"

#include "common/base/text/parse_text.h"
#include "common/comm/join_ticket.h"
#include "common/comm/tcp_channel.h"
#include "common/runs/run_files.h"

namespace treefarm {

JoinListener::JoinListener(Channel& channel, const Job::Farm& farm, std::uint64_t fingerprint,
                           const std::filesystem::path& run, const Log& log) {
    if (!farm.join) return;
    GuestOptions options;
    options.address = farm.join_address;
    options.port = static_cast<std::uint16_t>(farm.join_port);
    options.fingerprint = fingerprint;
    options.warning = [log](const std::string& text) { log->warn("{}", text); };
    const JoinTicket& ticket = channel.take_guests(options);
    const std::filesystem::path path = run / kTicketFileName;
    write_ticket(path, ticket);
    ticket_ = path;
    log->info("workers may join at {} port {}: treefarm join {}", ticket.address, ticket.port,
              shell_quoted(run.string()));
    log->debug("only guests are authenticated: the network between MPI processes is trusted");
}

JoinListener::~JoinListener() {
    std::error_code ignored;
    if (!ticket_.empty()) std::filesystem::remove(ticket_, ignored);
}

}  // namespace treefarm
