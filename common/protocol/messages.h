// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/base/bytes.h"
#include "common/film/aov_film.h"
#include "common/film/pixel_estimate.h"
#include "common/film/trace_stats.h"
#include "common/film/work_unit.h"
#include "common/plan/schedule/schedule.h"
#include "common/protocol/envelope.h"

namespace treefarm {

/// Limits of a message's content; anything larger is malformed.
inline constexpr std::uint32_t kMostThreads = 1u << 16;  ///< of one worker
inline constexpr std::size_t kMostNameBytes = 1024;      ///< a host's name, a version
inline constexpr std::size_t kMostTextBytes = 64 << 10;  ///< a reason, a failure
inline constexpr std::size_t kMostJobBytes = 16 << 20;   ///< a job as text

/// Messages between coordinator and workers (grammar: docs/design/protocol.md). An incarnation is a random number that
/// a worker draws at its start; with the peer number it identifies one life of one process, so that messages still
/// under way from an earlier life are recognised and dropped.

struct Hello {
    static constexpr Kind kKind = Kind::hello;
    std::uint64_t incarnation = 0;
    std::uint64_t fingerprint = 0;  ///< equal fingerprints promise equal bits (fingerprint.h)
    std::uint32_t threads = 0;      ///< tracing threads
    std::uint32_t job = 0;         ///< number of the job this message belongs to: that of the last rejoin, 0 before any
    std::uint64_t scene_hash = 0;  ///< of the scene kept from an earlier life or job; 0: none
    std::uint64_t memory = 0;      ///< bytes that the host can still provide; 0: unknown
    std::string host;
    std::string version;  ///< of the program

    bool operator==(const Hello&) const = default;
};

struct Welcome {
    static constexpr Kind kKind = Kind::welcome;
    std::uint32_t worker = 0;        ///< peer number of the worker
    double heartbeat_seconds = 1.0;  ///< interval of heartbeats, either way
    std::string job;                 ///< TOML text of the resolved job
    std::uint64_t scene_hash = 0;    ///< of the encoded scene, which is sent unless the worker has it
    std::uint64_t scene_bytes = 0;   ///< size of the scene, so that a worker notices if no piece of it arrives
    bool keep_scene = false;         ///< the scene is needed again: more jobs may follow

    bool operator==(const Welcome&) const = default;
};

struct Refuse {
    static constexpr Kind kKind = Kind::refuse;
    std::string reason;

    bool operator==(const Refuse&) const = default;
};

/// Data sent along a chain of workers.
enum class Blob : std::uint8_t { scene, tree };

/// A piece of a broadcast. The receiver forwards it to chain[0] with the rest of the chain.
struct Chunk {
    static constexpr Kind kKind = Kind::chunk;
    Blob blob = Blob::scene;
    std::uint32_t job = 0;
    std::uint32_t epoch = 0;   ///< of a tree: the pass that it guides; 0 for the scene
    std::uint64_t total = 0;   ///< bytes of the whole
    std::uint64_t offset = 0;  ///< of this piece
    std::vector<std::uint32_t> chain;
    Bytes bytes;

    bool operator==(const Chunk&) const = default;
};

/// Request for a blob, directly, from this offset on.
struct Resend {
    static constexpr Kind kKind = Kind::resend;
    Blob blob = Blob::scene;
    std::uint32_t job = 0;
    std::uint32_t epoch = 0;
    std::uint64_t offset = 0;

    bool operator==(const Resend&) const = default;
};

struct PassBegin {
    static constexpr Kind kKind = Kind::pass_begin;
    PassPlan plan;
    std::uint64_t tree_bytes = 0;  ///< length and hash of the encoded tree that guides the pass
    std::uint64_t tree_hash = 0;
    double result_seconds = 0;  ///< interval between results of a worker, except at the end

    bool operator==(const PassBegin&) const;
};

/// Credit: number of units of this pass that the worker can take beyond earlier requests. Zero only reports how little
/// it has left.
struct Want {
    static constexpr Kind kKind = Kind::want;
    std::uint64_t incarnation = 0;
    std::uint32_t pass = 0;
    std::uint32_t units = 0;
    std::uint64_t queued = 0;  ///< paths of its units that are not begun

    bool operator==(const Want&) const = default;
};

/// Units granted to a worker. An empty list means that nothing is left for now, so the worker should send its results.
struct Work {
    static constexpr Kind kKind = Kind::work;
    std::uint32_t pass = 0;
    std::vector<WorkUnit> units;  ///< units of this pass
    bool alone = false;           ///< the result must be sent at once, alone

    bool operator==(const Work&) const = default;
};

/// Units that are finished; workers need not begin them.
struct Drop {
    static constexpr Kind kKind = Kind::drop;
    std::uint32_t pass = 0;
    std::vector<WorkUnit> units;  ///< units of this pass

    bool operator==(const Drop&) const = default;
};

/// A finished unit: the estimates of its pixels, row by row, if it has any.
struct UnitResult {
    WorkUnit unit;
    std::vector<PixelEstimate> pixels;
    AovPixels aovs;  ///< AOVs that the job requests
};

/// Finished units and the evidence of exactly these units: result and acknowledgement in one message.
struct Result {
    static constexpr Kind kKind = Kind::result;
    std::uint64_t incarnation = 0;
    std::uint32_t pass = 0;
    std::vector<UnitResult> units;
    Bytes evidence;  ///< Evidence::encode()
    Bytes splats;    ///< SplatSums::encode() of exactly these units; empty if the pass has none
    TraceStats stats;
};

/// Sign of life. From a worker also its work so far, delivered or not, for the progress display.
struct Heartbeat {
    static constexpr Kind kKind = Kind::heartbeat;
    std::uint64_t incarnation = 0;  ///< 0 from the coordinator
    std::uint64_t samples = 0;
    std::uint64_t rays = 0;

    bool operator==(const Heartbeat&) const = default;
};

struct Failure {
    static constexpr Kind kKind = Kind::failure;
    std::uint64_t incarnation = 0;
    std::string text;

    bool operator==(const Failure&) const = default;
};

/// Order to discard all work, draw a new incarnation and say hello to this job: another job begins, or the worker was
/// considered lost and its units were issued again.
struct Rejoin {
    static constexpr Kind kKind = Kind::rejoin;
    std::uint32_t job = 0;

    bool operator==(const Rejoin&) const = default;
};

struct Quit {
    static constexpr Kind kKind = Kind::quit;
    bool operator==(const Quit&) const = default;
};

struct Bye {
    static constexpr Kind kKind = Kind::bye;
    std::uint64_t incarnation = 0;

    bool operator==(const Bye&) const = default;
};

struct Leave {
    static constexpr Kind kKind = Kind::leave;
    bool finalize = false;  ///< no worker was lost: the message layer may be shut down in order

    bool operator==(const Leave&) const = default;
};

using Message = std::variant<Hello, Welcome, Refuse, Chunk, Resend, PassBegin, Want, Work, Result, Heartbeat, Failure,
                             Rejoin, Quit, Bye, Leave, Drop>;

/// Function object that calls the member of `Overloads` for the message's type: std::visit(Overloads{...}, message).
template <class... Handlers>
struct Overloads : Handlers... {
    using Handlers::operator()...;
};
template <class... Handlers>
Overloads(Handlers...) -> Overloads<Handlers...>;

/// The sealed bytes of a message.
template <class M>
Bytes encode(const M& message);

/// Opens the envelope and reads the message. Malformed bytes throw FormatError before much is allocated.
Message decode(std::span<const std::uint8_t> bytes);

}  // namespace treefarm
