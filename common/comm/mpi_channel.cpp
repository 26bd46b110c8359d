// SPDX-License-Identifier: Apache-2.0
#include "common/comm/mpi_channel.h"

#define OMPI_SKIP_MPICXX  // the C++ bindings of MPI 2 were removed from the standard
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <thread>
#include <utility>

#include "common/base/error.h"
#include "common/base/timer.h"
#include "common/comm/idle_pause.h"
#include "common/comm/launcher_watch.h"
#include "common/comm/sealed_channel.h"

namespace treefarm {

namespace {

/// Greatest part of a message, in bytes: MPI counts in int, and short transfers mean short waits.
constexpr std::size_t kPartBytes = std::size_t{64} << 20;

/// Seconds to wait for sends to finish if a peer was lost; sends to the lost peer never do.
constexpr double kDisorderlyDrainSeconds = 1.0;

/// Seconds that mpirun may take to notice that its ranks have left: after a failed start; and at the end, where other
/// ranks finish their work.
constexpr unsigned kLauncherPatienceAtStart = 4, kLauncherPatienceAtEnd = 10;
constexpr char kLauncherStayed[] =
    "treefarm: rank 0 is done, but mpirun goes on waiting for a rank that died or stands still: it is ended\n";

/// Tags on the farm's communicator.
enum Tag : int {
    tag_last = 1,  ///< the last or only part of a message
    tag_more = 2,  ///< a part that is followed by others
};

void check(int code, const char* call, int peer) {
    if (code == MPI_SUCCESS) return;
    char text[MPI_MAX_ERROR_STRING] = "";
    int length = 0;
    MPI_Error_string(code, text, &length);
    throw RunError(std::string(call) + (peer >= 0 ? " with rank " + std::to_string(peer) : "") +
                   " failed: " + std::string(text, static_cast<std::size_t>(length)));
}

bool test(MPI_Request& request, int peer) {
    int done = 0;
    check(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test", peer);
    return done != 0;
}

class MpiChannel final : public Channel {
  public:
    explicit MpiChannel(MPI_Comm communicator) : communicator_(communicator) {
        check(MPI_Comm_rank(communicator_, &rank_), "MPI_Comm_rank", -1);
        check(MPI_Comm_size(communicator_, &size_), "MPI_Comm_size", -1);
    }

    int self() const override { return rank_; }
    int peer_count() const override { return size_; }

    void send(int peer, Payload payload) override {
        sent_ += payload->size();
        std::size_t at = 0;
        do {
            const std::size_t count = std::min(kPartBytes, payload->size() - at);
            const int tag = at + count == payload->size() ? tag_last : tag_more;
            Outgoing& out = outgoing_.emplace_back(Outgoing{payload, MPI_REQUEST_NULL, peer});
            check(MPI_Isend(payload->data() + at, static_cast<int>(count), MPI_BYTE, peer, tag, communicator_,
                            &out.request),
                  "MPI_Isend", peer);
            at += count;
        } while (at < payload->size());
        pause_.reset();
    }

    std::optional<Received> poll() override {
        sweep_outgoing();
        start_receives();
        for (auto& [peer, inbox] : inboxes_)
            if (auto message = progress(peer, inbox)) {
                pause_.reset();
                received_ += message->bytes.size();
                return message;
            }
        return std::nullopt;
    }

    bool drained() override {
        sweep_outgoing();
        return outgoing_.empty();
    }

    void rest(double seconds) override { pause_.rest(seconds, !outgoing_.empty() || receiving_ > 0); }

    std::uint64_t bytes_sent() const override { return sent_; }
    std::uint64_t bytes_received() const override { return received_; }

  private:
    /// A buffer belongs to its request until MPI reports completion; those of a dead peer stay until the end.
    struct Outgoing {
        Payload payload;
        MPI_Request request;
        int peer;
    };
    struct Part {
        Bytes bytes;
        MPI_Request request = MPI_REQUEST_NULL;
        bool last = true;
        bool cut = false;  ///< part of a message that is too long: received into an empty buffer
    };
    struct Inbox {
        std::list<Part> parts;  ///< in the order of sending; requests must not move
        Bytes assembled;
        std::size_t coming = 0;  ///< bytes of the message being received
        bool too_long = false;   ///< the message being assembled
    };

    void sweep_outgoing() {
        std::erase_if(outgoing_, [&](Outgoing& out) {
            if (!treefarm::test(out.request, out.peer)) return false;
            pause_.reset();
            return true;
        });
    }

    void start_receives() {
        for (;;) {
            int there = 0;
            MPI_Status status;
            check(MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, communicator_, &there, &status), "MPI_Iprobe", -1);
            if (!there) return;
            int count = 0;
            check(MPI_Get_count(&status, MPI_BYTE, &count), "MPI_Get_count", status.MPI_SOURCE);
            Inbox& inbox = inboxes_[status.MPI_SOURCE];
            Part& part = inbox.parts.emplace_back();
            part.last = status.MPI_TAG != tag_more;
            inbox.coming += static_cast<std::size_t>(count);
            part.cut = inbox.coming > kLongestMessage;
            if (part.last) inbox.coming = 0;
            if (!part.cut) part.bytes.resize(static_cast<std::size_t>(count));
            ++receiving_;
            check(MPI_Irecv(part.bytes.data(), static_cast<int>(part.bytes.size()), MPI_BYTE, status.MPI_SOURCE,
                            status.MPI_TAG, communicator_, &part.request),
                  "MPI_Irecv", status.MPI_SOURCE);
            pause_.reset();
        }
    }

    bool test(Part& part, int peer) {
        if (!part.cut) return treefarm::test(part.request, peer);
        int done = 0;  // with MPI_ERR_TRUNCATE
        (void)MPI_Test(&part.request, &done, MPI_STATUS_IGNORE);
        return done != 0 || part.request == MPI_REQUEST_NULL;
    }

    /// Parts of a peer may finish out of order; they are delivered in order.
    std::optional<Received> progress(int peer, Inbox& inbox) {
        while (!inbox.parts.empty() && test(inbox.parts.front(), peer)) {
            Part part = std::move(inbox.parts.front());
            inbox.parts.pop_front();
            --receiving_;
            inbox.too_long |= part.cut;
            if (inbox.too_long) {  // the receiver gets an empty message
                inbox.assembled = {};
                if (part.last) inbox.too_long = false;
            } else if (inbox.assembled.empty())
                inbox.assembled = std::move(part.bytes);
            else
                inbox.assembled.insert(inbox.assembled.end(), part.bytes.begin(), part.bytes.end());
            if (part.last) return Received{peer, std::exchange(inbox.assembled, {})};
        }
        return std::nullopt;
    }

    MPI_Comm communicator_;
    int rank_ = 0, size_ = 1;
    std::list<Outgoing> outgoing_;
    std::map<int, Inbox> inboxes_;
    int receiving_ = 0;  ///< parts under way
    IdlePause pause_;
    std::uint64_t sent_ = 0, received_ = 0;
};

/// Number of workers on this host. Collective, so for the start only, while all processes live.
int count_workers_on_host(MPI_Comm communicator) {
    int rank = 0, workers = 0;
    check(MPI_Comm_rank(communicator, &rank), "MPI_Comm_rank", -1);
    MPI_Comm host = MPI_COMM_NULL;
    check(MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, rank, MPI_INFO_NULL, &host), "MPI_Comm_split_type",
          -1);
    const int own = rank != 0;
    check(MPI_Allreduce(&own, &workers, 1, MPI_INT, MPI_SUM, host), "MPI_Allreduce", -1);
    check(MPI_Comm_free(&host), "MPI_Comm_free", -1);
    return workers;
}

/// Nonces of all processes if each has the secret; else none. Collective, so for the start only.
std::vector<JoinKey> exchange_nonces(MPI_Comm communicator, int size, bool has_secret) {
    const int mine = has_secret;
    int all = 0;
    check(MPI_Allreduce(&mine, &all, 1, MPI_INT, MPI_MIN, communicator), "MPI_Allreduce", -1);
    if (!all) return {};
    const JoinKey own = draw_join_key();
    std::vector<JoinKey> nonces(static_cast<std::size_t>(size));
    check(MPI_Allgather(own.data(), sizeof own, MPI_BYTE, nonces.data(), sizeof own, MPI_BYTE, communicator),
          "MPI_Allgather", -1);
    return nonces;
}

/// Watchdog that ends the process after a last action unless it is cancelled in time.
class Deadline {
  public:
    Deadline(double seconds, int exit_code, std::function<void()> last_act)
        : last_act_(std::move(last_act)), thread_([this, seconds, exit_code] { wait(seconds, exit_code); }) {}
    ~Deadline() {
        {
            const std::scoped_lock lock(mutex_);
            met_ = true;
        }
        changed_.notify_one();
        thread_.join();
    }

  private:
    void wait(double seconds, int exit_code) {
        std::unique_lock lock(mutex_);
        if (changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return met_; })) return;
        last_act_();
        _exit(exit_code);
    }

    const std::function<void()> last_act_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool met_ = false;
    std::thread thread_;
};

}  // namespace

class MpiSession::Impl {
  public:
    MPI_Comm communicator = MPI_COMM_NULL;
    int workers_on_host = 0;
    std::unique_ptr<MpiChannel> channel;
    std::unique_ptr<SealedChannel> sealed;
};

MpiSession::MpiSession(double patience, const std::string& complaint, const std::optional<JoinKey>& secret)
    : impl_(std::make_unique<Impl>()) {
    const Deadline deadline(patience, 1, [&complaint] {
        end_launcher_that_stays(kLauncherPatienceAtStart, complaint);
        (void)!::write(STDERR_FILENO, complaint.data(), complaint.size());
    });
    int provided = 0;
    check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread", -1);
    check(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler", -1);
    check(MPI_Comm_dup(MPI_COMM_WORLD, &impl_->communicator), "MPI_Comm_dup", -1);
    check(MPI_Comm_set_errhandler(impl_->communicator, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler", -1);
    impl_->workers_on_host = count_workers_on_host(impl_->communicator);
    impl_->channel = std::make_unique<MpiChannel>(impl_->communicator);
    const std::vector<JoinKey> nonces = exchange_nonces(impl_->communicator, size(), secret.has_value());
    if (!nonces.empty()) impl_->sealed = std::make_unique<SealedChannel>(*impl_->channel, *secret, nonces);
}

MpiSession::~MpiSession() = default;

int MpiSession::rank() const {
    return impl_->channel->self();
}

int MpiSession::size() const {
    return impl_->channel->peer_count();
}

int MpiSession::workers_on_host() const {
    return impl_->workers_on_host;
}

bool MpiSession::is_sealed() const {
    return impl_->sealed != nullptr;
}

Channel& MpiSession::channel() {
    if (impl_->sealed) return *impl_->sealed;
    return *impl_->channel;
}

void MpiSession::finish(bool orderly, int exit_code, double patience) {
    const Timer timer;
    Channel& channel = *impl_->channel;  // messages that still arrive are dropped
    const double drain_seconds = orderly ? patience : std::min(patience, kDisorderlyDrainSeconds);
    while (!channel.drained() && timer.seconds() < drain_seconds) {
        channel.poll();  // messages that still arrive are dropped
        channel.rest(1e-3);
    }
    const auto see_to_launcher = [&] {
        if (rank() == 0) end_launcher_that_stays(kLauncherPatienceAtEnd, kLauncherStayed);
    };
    if (!orderly || !channel.drained()) {
        see_to_launcher();
        _exit(exit_code);
    }
    const Deadline deadline(patience, exit_code, see_to_launcher);
    MPI_Comm_free(&impl_->communicator);
    MPI_Finalize();
}

}  // namespace treefarm
