#pragma once

#include <string>

namespace treefarm {

/// Leaves a process behind that ends the mpirun which started this one, if it still runs some seconds after its ranks
/// have left: killed at the wrong moment of MPI_Init, a rank can wedge it (Open MPI 4.1). `last_words` go to mpirun's
/// own standard error then, since it forwards nothing any more. Does nothing where the parent is no mpirun. Safe while
/// other threads run.
void end_launcher_that_stays(const std::string& last_words);

}  // namespace treefarm
