// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "coordinator/launch/own_folder.h"
#include "coordinator/launch/start_command.h"

namespace treefarm {

/// Folders of one attempt for Open MPI's files, removed by the destructor. Each attempt has its own, since those of the
/// one before may have been removed by others: at a log-out, or to make room.
class AttemptFolders {
  public:
    /// Makes the folders and names them in the plan. Shared memory goes to the folder for temporary files if the usual
    /// one has no room. `key`: the attempt's key file, which sweep() finds by the folder. Throws FileError if mpirun
    /// would have no folder.
    AttemptFolders(StartPlan& plan, const std::filesystem::path& key);

    /// Reason why shared memory is not in the usual folder; "" if it is.
    const std::string& trouble() const { return trouble_; }

  private:
    std::unique_ptr<OwnFolder> temporary_, shared_memory_;
    std::string trouble_;
};

}  // namespace treefarm
