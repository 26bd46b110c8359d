// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "coordinator/checkpoint/state_codec.h"

namespace treefarm {

/// Folder of the checkpoints in a run directory.
inline constexpr const char* kCheckpointFolder = "checkpoint";

/// A checkpoint as it was read.
struct LoadedCheckpoint {
    std::uint64_t generation = 0;
    CheckpointOrigin origin;
    RenderState state;
    std::vector<std::string> warnings;  ///< of a newer one that is damaged
};

/// The newest usable checkpoint of a run. `check` refuses one whose origin does not fit, by throwing. Throws InputError
/// where there is none, with what is wrong with each.
LoadedCheckpoint load_checkpoint(const std::filesystem::path& run,
                                 const std::function<void(const CheckpointOrigin&)>& check);

/// Writes checkpoints in two generations, a and b, by turns, and films in files of their own, each once. At any moment
/// one that was written whole is there. Every file outlives the power before one that names it is begun.
class CheckpointStore {
  public:
    /// `loaded`: what the render goes on from, or nullptr.
    explicit CheckpointStore(std::filesystem::path run, const LoadedCheckpoint* loaded = nullptr);

    /// Takes what has to be written of a state, naming its films; the result writes it, in any thread, as often as it
    /// takes, and throws FileError.
    std::function<void()> prepare(const CheckpointOrigin& origin, RenderState& state);

    /// Bytes of the last one that was prepared, its films included.
    std::uint64_t bytes() const { return bytes_; }

    /// Removes the folder, where its files are all ours.
    void remove();

  private:
    using Names = std::set<std::string>;

    void write(const SectionFile& file, const Names& films);
    void write_films(const Names& films);
    void remove_unnamed() const;

    const std::filesystem::path folder_;
    std::uint64_t generation_ = 0, bytes_ = 0;
    std::mutex mutex_;  ///< of what follows
    struct Unwritten {
        std::shared_ptr<const Bytes> bytes;
        std::uint64_t generation;  ///< that first names it
    };
    std::map<std::string, Unwritten> unwritten_;
    std::array<Names, 2> named_;  ///< films, by generation modulo 2
};

}  // namespace treefarm
