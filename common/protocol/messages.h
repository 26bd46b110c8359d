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

/// Bounds of what one message may say: more is no message of ours.
inline constexpr std::uint32_t kMostThreads = 1u << 16;  ///< of one worker
inline constexpr std::size_t kMostNameBytes = 1024;      ///< a host's name, a version
inline constexpr std::size_t kMostTextBytes = 64 << 10;  ///< a reason, a failure
inline constexpr std::size_t kMostJobBytes = 16 << 20;   ///< a job as text

/// The messages between coordinator and workers (docs/design/protocol.md is the grammar). An incarnation is a random
/// number that a worker draws when it starts: together with its peer number it names one life of one process, so that
/// what an earlier life still had under way is recognised and dropped.

struct Hello {
    static constexpr Kind kKind = Kind::hello;
    std::uint64_t incarnation = 0;
    std::uint64_t fingerprint = 0;  ///< equal fingerprints promise equal bits (fingerprint.h)
    std::uint32_t threads = 0;      ///< that trace
    std::uint32_t job = 0;          ///< which one it speaks of: that of the last rejoin, 0 before any
    std::uint64_t scene_hash = 0;   ///< of the scene it holds, from an earlier life or job; 0: none
    std::uint64_t memory = 0;       ///< bytes that its host can still give; 0: not known
    std::string host;
    std::string version;  ///< of the program

    bool operator==(const Hello&) const = default;
};

struct Welcome {
    static constexpr Kind kKind = Kind::welcome;
    std::uint32_t worker = 0;        ///< its peer number
    double heartbeat_seconds = 1.0;  ///< how often each side says that it lives
    std::string job;                 ///< TOML text of the resolved job
    std::uint64_t scene_hash = 0;    ///< of the encoded scene; it is sent unless the worker holds it
    std::uint64_t scene_bytes = 0;   ///< so that a scene of which no piece ever comes is missed
    bool keep_scene = false;         ///< other jobs may follow

    bool operator==(const Welcome&) const = default;
};

struct Refuse {
    static constexpr Kind kKind = Kind::refuse;
    std::string reason;

    bool operator==(const Refuse&) const = default;
};

/// Data that travels along a chain of workers.
enum class Blob : std::uint8_t { scene, tree };

/// A piece of a broadcast. Who receives it forwards it to chain[0] with the rest of the chain.
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

/// Send me this blob again, directly, from this offset on.
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
    double result_seconds = 0;  ///< between two results of a worker, but at the end

    bool operator==(const PassBegin&) const;
};

/// Credit: the worker can take so many more units of this pass than it asked for before. None: it only says how little
/// it has left.
struct Want {
    static constexpr Kind kKind = Kind::want;
    std::uint64_t incarnation = 0;
    std::uint32_t pass = 0;
    std::uint32_t units = 0;
    std::uint64_t queued = 0;  ///< paths of the units that it has and has not begun

    bool operator==(const Want&) const = default;
};

/// Units that a worker gets for its credit. None: for now nothing is left, so it had better send what it has.
struct Work {
    static constexpr Kind kKind = Kind::work;
    std::uint32_t pass = 0;
    std::vector<WorkUnit> units;  ///< all of that pass
    bool alone = false;           ///< what they bring is to be sent as soon as it is there, with nothing else

    bool operator==(const Work&) const = default;
};

/// Units that are done: whoever has not begun them need not.
struct Drop {
    static constexpr Kind kKind = Kind::drop;
    std::uint32_t pass = 0;
    std::vector<WorkUnit> units;  ///< all of that pass

    bool operator==(const Drop&) const = default;
};

/// A finished unit: the estimates of its pixels, row by row, if it has any.
struct UnitResult {
    WorkUnit unit;
    std::vector<PixelEstimate> pixels;
    AovPixels aovs;  ///< as the job asks for
};

/// Finished units and what exactly these units taught the tree: result and acknowledgement in one.
struct Result {
    static constexpr Kind kKind = Kind::result;
    std::uint64_t incarnation = 0;
    std::uint32_t pass = 0;
    std::vector<UnitResult> units;
    Bytes update;  ///< CellSums::encode(); empty when the pass records nothing
    Bytes splats;  ///< SplatSums::encode() of exactly these units; empty where the pass has none
    TraceStats stats;
};

/// Alive. From a worker also what it has done so far in all, delivered or not, for the progress display.
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

/// Drop what you have, draw a new incarnation and say hello to this job: another one begins, or you were given up for
/// lost and what you had was issued again.
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
    bool finalize = false;  ///< nobody was lost: the message layer may be shut down in order

    bool operator==(const Leave&) const = default;
};

using Message = std::variant<Hello, Welcome, Refuse, Chunk, Resend, PassBegin, Want, Work, Result, Heartbeat, Failure,
                             Rejoin, Quit, Bye, Leave, Drop>;

/// Calls the member of `Overloads` that takes the message's type: std::visit(Overloads{...}, message).
template <class... Handlers>
struct Overloads : Handlers... {
    using Handlers::operator()...;
};
template <class... Handlers>
Overloads(Handlers...) -> Overloads<Handlers...>;

/// The sealed bytes of a message.
template <class M>
Bytes encode(const M& message);

/// Opens the envelope and reads the message; anything malformed throws FormatError before much is allocated.
Message decode(std::span<const std::uint8_t> bytes);

}  // namespace treefarm
