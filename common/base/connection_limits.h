// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace treefarm {

/// Whether a descriptor is one of the last sixteen that this process may open: they are kept back from strangers, for
/// files.
bool is_kept_for_files(int descriptor);

/// Index of the connection to close if there are too many: the oldest from the address with most of them, so that many
/// connections from one host do not keep others out. `addresses`: of all connections, oldest first; not empty.
std::size_t connection_to_close(std::span<const std::string> addresses);

}  // namespace treefarm
