// SPDX-License-Identifier: Apache-2.0
#include "common/comm/in_process_channel.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>

namespace treefarm {

namespace {

struct Inbox {
    struct Item {
        int peer;
        Payload payload;
    };
    std::mutex mutex;
    std::condition_variable arrived;
    std::deque<Item> items;
};

using Inboxes = std::vector<Inbox>;

class InProcessChannel final : public Channel {
  public:
    InProcessChannel(std::shared_ptr<Inboxes> inboxes, int self) : inboxes_(std::move(inboxes)), self_(self) {}

    int self() const override { return self_; }
    int peer_count() const override { return static_cast<int>(inboxes_->size()); }

    void send(int peer, Payload payload) override {
        sent_ += payload->size();
        Inbox& inbox = inboxes_->at(static_cast<std::size_t>(peer));
        const std::scoped_lock lock(inbox.mutex);
        inbox.items.push_back({self_, std::move(payload)});
        inbox.arrived.notify_one();
    }

    std::optional<Received> poll() override {
        Inbox& inbox = own();
        Inbox::Item item;
        {
            const std::scoped_lock lock(inbox.mutex);
            if (inbox.items.empty()) return std::nullopt;
            item = std::move(inbox.items.front());
            inbox.items.pop_front();
        }
        received_ += item.payload->size();
        return Received{item.peer, *item.payload};
    }

    bool drained() override { return true; }

    void rest(double seconds) override {
        Inbox& inbox = own();
        std::unique_lock lock(inbox.mutex);
        inbox.arrived.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return !inbox.items.empty(); });
    }

    std::uint64_t bytes_sent() const override { return sent_; }
    std::uint64_t bytes_received() const override { return received_; }

  private:
    Inbox& own() { return (*inboxes_)[static_cast<std::size_t>(self_)]; }

    std::shared_ptr<Inboxes> inboxes_;
    int self_;
    std::uint64_t sent_ = 0, received_ = 0;
};

}  // namespace

std::vector<std::unique_ptr<Channel>> make_in_process_channels(int peers) {
    auto inboxes = std::make_shared<Inboxes>(static_cast<std::size_t>(peers));
    std::vector<std::unique_ptr<Channel>> channels;
    channels.reserve(static_cast<std::size_t>(peers));
    for (int self = 0; self < peers; ++self)
        channels.push_back(std::make_unique<InProcessChannel>(inboxes, self));
    return channels;
}

}  // namespace treefarm
