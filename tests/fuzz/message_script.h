// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/protocol/messages.h"

namespace treefarm::fuzz {

/// Numbers out of a fuzz input, zeros once it has ended: every input is a whole script.
class Script {
  public:
    explicit Script(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    bool done() const { return at_ >= bytes_.size(); }
    std::uint8_t byte() { return done() ? std::uint8_t{0} : bytes_[at_++]; }
    std::uint32_t below(std::uint32_t n) { return byte() % n; }
    bool one_in(std::uint32_t n) { return below(n) == 0; }
    std::uint64_t number();  ///< often small, sometimes at an edge, sometimes any

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

/// A peer's knowledge of the conversation, with which its nonsense gets past the first door.
struct Known {
    std::uint64_t incarnation = 0;
    std::uint32_t job = 0, pass = 0;
    std::uint64_t fingerprint = 0;
    std::uint64_t scene_hash = 0, scene_bytes = 0, tree_hash = 0, tree_bytes = 0;
    std::vector<WorkUnit> units;  ///< that it was given
    Bytes scene, tree;
    int width = 1, height = 1;
};

/// Any message, well-formed: its envelope and counts are right, and often so are its fields. A result in it always has
/// something that can be seen to be wrong: a lie that nobody can see is no matter of messages.
Bytes any_message(Script& script, const Known& known);

}  // namespace treefarm::fuzz
