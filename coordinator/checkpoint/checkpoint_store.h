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

#include "common/base/error.h"
#include "common/runs/run_files.h"
#include "coordinator/checkpoint/state_codec.h"

namespace treefarm {

/// A checkpoint read from disk.
struct LoadedCheckpoint {
    std::uint64_t generation = 0;
    std::uint64_t newest = 0;  ///< highest generation in either file, usable or not
    std::size_t slot = 0;      ///< file that it was read from: 0 for a, 1 for b
    CheckpointOrigin origin;
    RenderState state;
    std::vector<PassPlan> plans;        ///< of its passes, and of those that a newer file without its films names
    std::set<std::string> other_films;  ///< films named by the other file
    std::set<std::string> lost_films;   ///< films whose file is missing or damaged: they have no pixels
    std::vector<std::string> warnings;  ///< damage of a newer checkpoint, if any
};

/// Highest generation stated by a run's checkpoint files, usable or not; 0: none.
std::uint64_t newest_generation(const std::filesystem::path& run);

/// Whether a run has a checkpoint file, usable or not. A folder may hold films alone: a render was killed before it had
/// written its first checkpoint.
bool has_checkpoint_file(const std::filesystem::path& run);

/// Whether a render can go on in the run directory: it has its job, and load_checkpoint() would find a usable
/// checkpoint, if the origin fits. A directory that was removed while it was rendered may have got a checkpoint without
/// a job.
bool can_go_on(const std::filesystem::path& run);

/// Error of a run without a usable checkpoint, with the fault of each file.
class NoCheckpoint : public InputError {
  public:
    using InputError::InputError;
};

/// Loads the newest usable checkpoint of a run, or if both name a missing or damaged film the newer one, without the
/// pixels of such films. `check` throws if the origin does not fit. Throws NoCheckpoint.
LoadedCheckpoint load_checkpoint(const std::filesystem::path& run,
                                 const std::function<void(const CheckpointOrigin&)>& check);

/// Writer of checkpoints in two alternating generations, a and b, with each film in a file of its own, written once. At
/// any moment one complete checkpoint exists. Every file is synced to disk before a file that names it is begun.
class CheckpointStore {
  public:
    /// `loaded`: the checkpoint being resumed, or nullptr.
    explicit CheckpointStore(const std::filesystem::path& run, const LoadedCheckpoint* loaded = nullptr);

    /// Prepares the writing of a state: names its films and takes its partial pass. The returned function writes it, in
    /// any thread and any number of times, and throws FileError.
    std::function<void()> prepare(const CheckpointOrigin& origin, RenderState& state);

    /// Writes a checkpoint of the state now, one film after the other, without a copy of all films. No prepared
    /// checkpoint may be in progress. Throws FileError.
    void write(const CheckpointOrigin& origin, RenderState& state);

    /// Removes the folder if it contains no files but ours.
    void remove();

  private:
    using Names = std::set<std::string>;
    using Films = std::map<std::string, std::shared_ptr<const Bytes>>;

    void write_generation(const SectionFile& file, const Names& names, const Films& films);
    void write_films(const Films& films);
    void write_film(const std::string& name, std::span<const std::uint8_t> bytes);
    /// Whether a film's file is there and this process read or wrote it: one of the same name may be damaged. The mutex
    /// is held.
    bool has_intact(const std::string& name) const;
    void make_folder() const;
    void remove_unnamed() const;

    const std::filesystem::path folder_;
    std::uint64_t generation_ = 0;  ///< of the checkpoint last prepared or written
    std::mutex mutex_;              ///< guards the members below
    Names intact_;                  ///< films whose files were read or written by this process
    Films unwritten_;               ///< of the checkpoint last prepared
    std::size_t slot_ = 0;          ///< file that is written next: 0 for a, 1 for b
    std::array<Names, 2> named_;    ///< names of films, by slot
};

}  // namespace treefarm
