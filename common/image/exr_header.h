// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace treefarm {

/// Walks the headers of an OpenEXR file. Throws InputError if attributes, chunks, tiles or pixels claim more than the
/// file's bytes can hold, since OpenEXR allocates by these claims before it checks them. All other checks are left to
/// OpenEXR.
void check_exr_header(const std::filesystem::path& path);

}  // namespace treefarm
