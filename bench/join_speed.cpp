// SPDX-License-Identifier: Apache-2.0
// Speed of the guests' channel on the loopback: round trips of 8 bytes, and MiB/s of long messages from the coordinator
// to a guest, MACs included.
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "common/base/timer.h"
#include "common/comm/tcp_channel.h"

namespace treefarm {
namespace {

constexpr std::size_t kMessages = 64, kLong = std::size_t{8} << 20;

Received await(Channel& channel) {
    for (;;) {
        if (auto message = channel.poll()) return std::move(*message);
        channel.rest(0.01);
    }
}

/// Guest that echoes short messages, and answers a long one with an empty one.
void answer(const JoinTicket& ticket) {
    const auto channel = join_run(ticket, 1);
    channel->send(0, std::make_shared<const Bytes>(8));
    while (channel->is_open(0)) {
        const auto message = channel->poll();
        if (!message) {
            channel->rest(0.01);
            continue;
        }
        channel->send(0, std::make_shared<const Bytes>(message->bytes.size() == kLong ? 0 : message->bytes.size()));
    }
}

void measure(std::size_t trips) {
    GuestOptions options;
    options.fingerprint = 1;
    TcpChannel listener(options, 1);
    std::thread guest([&] { answer(listener.ticket()); });
    await(listener);
    const Timer short_ones;
    for (std::size_t k = 0; k < trips; ++k) {
        listener.send(1, std::make_shared<const Bytes>(8));
        await(listener);
    }
    std::printf("round trip of 8 bytes: %.1f us\n", 1e6 * short_ones.seconds() / static_cast<double>(trips));
    const auto payload = std::make_shared<const Bytes>(kLong);
    const Timer long_ones;
    const double before = process_cpu_seconds();
    for (std::size_t k = 0; k < kMessages; ++k)
        listener.send(1, payload);
    for (std::size_t k = 0; k < kMessages; ++k)
        await(listener);
    const auto mib = static_cast<double>(kMessages * kLong >> 20);
    std::printf("messages of 8 MiB: %.0f MiB/s, %.2f core-seconds per GiB at both ends\n", mib / long_ones.seconds(),
                1024 * (process_cpu_seconds() - before) / mib);
    listener.close(1);
    guest.join();
}

}  // namespace
}  // namespace treefarm

int main(int argc, char** argv) {
    treefarm::measure(argc > 1 ? static_cast<std::size_t>(std::atoi(argv[1])) : 20'000);
    return 0;
}
