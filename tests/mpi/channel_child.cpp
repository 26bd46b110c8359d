// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "common/comm/mpi_channel.h"

// Runs under mpirun, started by channel_test: every worker sends the coordinator messages of many sizes, some of
// several parts; the coordinator sends each one back; the worker compares. Prints "worker K: N messages came back".

namespace treefarm {
namespace {

constexpr std::size_t kSizes[] = {
    1, 100, 0, std::size_t{150} << 20, 3, std::size_t{64} << 20, (std::size_t{64} << 20) + 1, 70'000, 2};

Bytes pattern(std::size_t size, int salt) {
    Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<std::uint8_t>(i * 2654435761u >> (i % 13)) + static_cast<std::uint8_t>(salt);
    return bytes;
}

void echo(Channel& channel, std::size_t count) {
    while (count > 0) {
        if (auto message = channel.poll()) {
            channel.send(message->peer, std::make_shared<const Bytes>(std::move(message->bytes)));
            --count;
        } else {
            channel.rest(1e-3);
        }
    }
    while (!channel.drained())
        channel.rest(1e-3);
}

int send_and_compare(Channel& channel) {
    for (const std::size_t size : kSizes)
        channel.send(0, std::make_shared<const Bytes>(pattern(size, channel.self())));
    int same = 0;
    for (const std::size_t size : kSizes) {
        std::optional<Received> message;
        while (!(message = channel.poll()))
            channel.rest(1e-3);
        same += message->bytes == pattern(size, channel.self());
    }
    return same;
}

}  // namespace
}  // namespace treefarm

int main() {
    using namespace treefarm;
    MpiSession session(60, "the processes did not come together\n");
    Channel& channel = session.channel();
    if (session.rank() == 0) {
        echo(channel, std::size(kSizes) * static_cast<std::size_t>(session.size() - 1));
        std::printf("%d workers on this host\n", session.workers_on_host());
    } else {
        std::printf("worker %d: %d messages came back\n", session.rank(), send_and_compare(channel));
    }
    std::fflush(stdout);
    session.finish(true, 0, 60);
    return 0;
}
