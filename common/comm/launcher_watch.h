// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace treefarm {

/// Leaves a process behind that ends the mpirun which started this one, if it still runs after `patience` seconds: a
/// rank that is killed at the wrong moment of MPI_Init can wedge it (Open MPI 4.1), and it waits for one that is
/// stopped for ever. `last_words` go to mpirun's own standard error then, since it may forward nothing any more. Does
/// nothing where the parent is no mpirun. Safe while other threads run.
void end_launcher_that_stays(unsigned patience, const std::string& last_words);

}  // namespace treefarm
