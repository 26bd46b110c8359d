// SPDX-License-Identifier: Apache-2.0
#include "common/comm/tcp_channel.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>

#include "common/base/connection_limits.h"
#include "common/base/error.h"
#include "common/base/host.h"
#include "common/base/timer.h"

namespace treefarm {

namespace {

/// Limit of warnings about unauthenticated connections, so that they cannot fill the log.
constexpr int kMostWarnings = 20;

TcpChannel::Clock or_real(TcpChannel::Clock clock) {
    if (clock) return clock;
    return [timer = Timer()] { return timer.seconds(); };
}

bool is_everywhere(const std::string& address) {
    return address == "0.0.0.0" || address == "::";
}

/// Sends a few bytes, which a fresh socket accepts at once.
bool send_at_once(const Socket& socket, const Bytes& bytes) {
    return bytes.empty() || ::send(socket.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
                                static_cast<ssize_t>(bytes.size());
}

}  // namespace

TcpChannel::TcpChannel(const GuestOptions& options, int first_peer, const GuestLimits& limits, Clock clock)
    : options_(options),
      limits_(limits),
      clock_(or_real(std::move(clock))),
      first_peer_(first_peer),
      next_peer_(first_peer),
      listener_(listen_at(options.address, options.port)),
      ticket_{draw_join_run(), is_everywhere(options.address) ? host_name() : options.address, listener_.port,
              draw_join_key()},
      scratch_(kScratchBytes) {}

TcpChannel::~TcpChannel() = default;

std::vector<int> TcpChannel::peers() const {
    std::vector<int> peers;
    for (const auto& [peer, guest] : links_)
        peers.push_back(peer);
    return peers;
}

std::size_t TcpChannel::unsent(int peer) const {
    const auto found = links_.find(peer);
    return found == links_.end() ? 0 : found->second.link.unsent();
}

void TcpChannel::send(int peer, Payload payload) {
    const auto found = links_.find(peer);
    if (found == links_.end()) return;
    sent_ += payload->size();
    TcpLink& link = found->second.link;
    const bool idle = link.unsent() == 0;
    link.send(std::move(payload));
    if (idle) link.write();
}

std::optional<Received> TcpChannel::poll() {
    const auto next = [&]() -> std::optional<Received> {
        auto at = links_.upper_bound(last_heard_);
        for (std::size_t k = 0; k < links_.size(); ++k, ++at) {
            if (at == links_.end()) at = links_.begin();
            if (auto message = at->second.link.take()) {
                last_heard_ = at->first;
                received_ += message->size();
                return Received{at->first, std::move(*message)};
            }
        }
        return std::nullopt;
    };
    if (auto message = next()) return message;
    move(true);
    return next();
}

bool TcpChannel::drained() {
    move(false);
    return !has_unsent();
}

bool TcpChannel::has_unsent() const {
    return std::any_of(links_.begin(), links_.end(), [](const auto& entry) { return entry.second.link.unsent() > 0; });
}

void TcpChannel::rest(double seconds) {
    wait(seconds, true);
}

/// Waits until a transfer can advance, at most `seconds`; false if none can.
bool TcpChannel::wait(double seconds, bool reading) const {
    std::vector<pollfd> ready;
    ready.push_back({listener_.socket.fd(), POLLIN, 0});
    for (const Visitor& visitor : visitors_)
        ready.push_back({visitor.socket.fd(), POLLIN, 0});
    for (const auto& [peer, guest] : links_) {
        const auto events = static_cast<short>((reading ? POLLIN : 0) | (guest.link.unsent() > 0 ? POLLOUT : 0));
        if (events != 0) ready.push_back({guest.link.fd(), events, 0});
    }
    const double whole = std::floor(seconds);
    const timespec time{static_cast<time_t>(whole), static_cast<long>((seconds - whole) * 1e9)};
    return ::ppoll(ready.data(), ready.size(), &time, nullptr) > 0;
}

/// Advances all transfers that can proceed without waiting.
void TcpChannel::move(bool reading) {
    const bool ready = wait(0, reading);
    if (ready) {
        accept_all();
        for (auto& [peer, guest] : links_) {
            guest.link.write();
            if (reading && !guest.link.has_message()) guest.link.read(scratch_);
        }
    }
    for (auto& [peer, guest] : links_)
        give_up_slow(guest);
    std::erase_if(links_, [&](const auto& entry) {
        const Guest& guest = entry.second;
        if (guest.link.is_open() || guest.link.has_message()) return false;
        if (guest.link.why_closed() != TcpLink::kFarewell)
            warn("worker " + std::to_string(entry.first) + " at " + guest.from +
                 " was cut off: " + guest.link.why_closed());
        return true;
    });
    for (auto at = visitors_.begin(); at != visitors_.end();)
        at = see_to(*at, ready) ? std::next(at) : visitors_.erase(at);
}

void TcpChannel::accept_all() {
    constexpr int kMostAtOnce = 64;  // a flood must not starve the guests
    for (int k = 0; k < kMostAtOnce; ++k) {
        auto accepted = accept_from(listener_.socket);
        if (!accepted) return;
        adopt(std::move(accepted->first), accepted->second);
    }
}

/// Closes the oldest of the unauthenticated connections from the address with most of them. Those with a proof go last.
void TcpChannel::push_out() {
    std::vector<std::list<Visitor>::iterator> candidates;
    for (const bool proven : {false, true}) {
        for (auto at = visitors_.begin(); at != visitors_.end(); ++at)
            if (at->handshake.has_proof() == proven) candidates.push_back(at);
        if (!candidates.empty()) break;
    }
    if (candidates.empty()) return;
    std::vector<std::string> addresses;
    for (const auto& at : candidates)
        addresses.push_back(at->from.substr(0, at->from.rfind(" port ")));
    const auto closed = candidates[connection_to_close(addresses)];
    send_at_once(closed->socket, refusal_answer(JoinRefusal::crowded));
    (void)::recv(closed->socket.fd(), scratch_.data(), scratch_.size(),
                 MSG_DONTWAIT);  // unread data would destroy the answer
    warn("a connection from " + closed->from + " was closed: " + std::to_string(visitors_.size()) +
         " connections are not authenticated yet");
    visitors_.erase(closed);
}

void TcpChannel::adopt(Socket socket, const std::string& from) {
    set_up(socket);
    if (is_kept_for_files(socket.fd())) {
        push_out();
        socket = Socket(::fcntl(socket.fd(), F_DUPFD_CLOEXEC, 0));
        if (!socket || is_kept_for_files(socket.fd())) {
            warn("a connection from " + from + " was closed: too few descriptors are left (ulimit -n)");
            return;
        }
    }
    visitors_.push_back({std::move(socket), from, clock_(), {ticket_, options_.fingerprint, draw_join_key()}});
    if (!see_to(visitors_.back(), true))  // what it has sent already may be its proof
        visitors_.pop_back();
    else if (visitors_.size() > limits_.most_unproven)
        push_out();
}

/// Handles data from an unauthenticated connection. Returns the fault, if any.
std::string TcpChannel::hear(Visitor& visitor) {
    const ssize_t count = ::recv(visitor.socket.fd(), scratch_.data(), kMostUnprovenBytes, MSG_DONTWAIT);
    if (count == 0) return "it closed the connection";
    if (count < 0) return errno == EAGAIN || errno == EINTR ? "" : std::strerror(errno);
    try {
        visitor.handshake.take(std::span(scratch_).first(static_cast<std::size_t>(count)));
    } catch (const FormatError& error) {
        return error.what();
    }
    return "";
}

/// Handles an unauthenticated connection, which may have data if `ready`. Returns whether to keep it.
bool TcpChannel::see_to(Visitor& visitor, bool ready) {
    std::string why = ready ? hear(visitor) : "";
    if (!send_at_once(visitor.socket, visitor.handshake.take_answer()) && why.empty())
        why = "the answer could not be sent";
    if (why.empty() && visitor.handshake.is_admitted()) {
        links_.emplace(next_peer_++, Guest{{std::move(visitor.socket), visitor.handshake.sending_key(),
                                            visitor.handshake.take_reader()},
                                           visitor.from,
                                           {}});
        return false;
    }
    if (why.empty() && clock_() - visitor.since > limits_.unproven_seconds)
        why = "it did not authenticate itself in time";
    if (why.empty()) return true;
    warn("a connection from " + visitor.from + " was closed: " + why);
    return false;
}

/// Closes the connection of a guest that does not receive, since its queue costs memory.
void TcpChannel::give_up_slow(Guest& guest) {
    const double now = clock_();
    const std::size_t unsent = guest.link.unsent();
    if (unsent <= limits_.most_unsent)
        guest.behind.reset();
    else if (!guest.behind)
        guest.behind = {unsent, now};
    else if (now - guest.behind->since >= limits_.unsent_seconds) {
        if (unsent >= guest.behind->bytes) guest.link.close("it receives more slowly than data are sent to it");
        guest.behind = {unsent, now};
    }
}

void TcpChannel::warn(const std::string& text) {
    if (++warnings_ > kMostWarnings || !options_.warning) return;
    options_.warning(text + (warnings_ == kMostWarnings ? "; further ones are not reported" : ""));
}

void TcpChannel::close(double seconds) {
    const double end = clock_() + seconds;
    while (!drained() && clock_() < end)
        wait(0.01, false);
    for (auto& [peer, guest] : links_)
        guest.link.end_sending();
    while (!links_.empty() && clock_() < end) {
        while (poll()) {  // no longer needed
        }
        wait(0.01, true);
    }
    links_.clear();
    visitors_.clear();
    listener_ = {};
}

}  // namespace treefarm
