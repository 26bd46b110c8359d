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

#include "common/runs/run_files.h"
#include "coordinator/checkpoint/state_codec.h"

namespace treefarm {

/// A checkpoint as it was read.
struct LoadedCheckpoint {
    std::uint64_t generation = 0;
    std::uint64_t newest = 0;  ///< generation that any file said, usable or not
    std::size_t slot = 0;      ///< of its file: 0 of a, 1 of b
    CheckpointOrigin origin;
    RenderState state;
    std::set<std::string> other_films;  ///< that the other file names
    std::vector<std::string> warnings;  ///< of a newer one that is damaged
};

/// The newest generation that the files of a run say they are, usable or not; 0: there is none.
std::uint64_t newest_generation(const std::filesystem::path& run);

/// The newest usable checkpoint of a run. `check` refuses one whose origin does not fit, by throwing. Throws InputError
/// where there is none, with what is wrong with each.
LoadedCheckpoint load_checkpoint(const std::filesystem::path& run,
                                 const std::function<void(const CheckpointOrigin&)>& check);

/// Writes checkpoints in two generations, a and b, by turns, and films in files of their own, each once. At any moment
/// one that was written whole is there. Every file outlives the power before one that names it is begun.
class CheckpointStore {
  public:
    /// `loaded`: what the render goes on from, or nullptr.
    explicit CheckpointStore(const std::filesystem::path& run, const LoadedCheckpoint* loaded = nullptr);

    /// Takes what has to be written of a state, naming its films; a pass in hand leaves it. The result writes it, in
    /// any thread, as often as it takes, and throws FileError.
    std::function<void()> prepare(const CheckpointOrigin& origin, RenderState& state);

    /// Writes a checkpoint of the state now, one film after the other: it takes no memory for a copy of them all.
    /// Nothing that was prepared may be on its way. Throws FileError.
    void write(const CheckpointOrigin& origin, RenderState& state);

    /// Removes the folder, where its files are all ours.
    void remove();

  private:
    using Names = std::set<std::string>;
    using Films = std::map<std::string, std::shared_ptr<const Bytes>>;

    void write_generation(const SectionFile& file, const Names& names, const Films& films);
    void write_films(const Films& films);
    void make_folder() const;
    void remove_unnamed() const;

    const std::filesystem::path folder_;
    std::uint64_t generation_ = 0;  ///< of the last that was prepared or written
    std::mutex mutex_;              ///< of what follows
    Films unwritten_;               ///< of the last that was prepared
    std::size_t slot_ = 0;          ///< of the file that is written next
    std::array<Names, 2> named_;    ///< films, by slot
};

}  // namespace treefarm
