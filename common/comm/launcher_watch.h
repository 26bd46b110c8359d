// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Starts a background process that ends the mpirun of this process if it still runs after `patience` seconds. A rank
/// killed at the wrong moment of MPI_Init can block mpirun (Open MPI 4.1), and mpirun waits forever for a stopped rank.
/// `last_words` are then written to mpirun's standard error, since it may no longer forward output. Does nothing if the
/// parent is not mpirun. Safe while other threads run.
void end_launcher_that_stays(unsigned patience, const std::string& last_words);

}  // namespace treefarm
