// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace treefarm {

/// Walks the headers of an OpenEXR file and throws InputError where they claim more than the file's bytes can hold:
/// attributes, chunks, tiles or pixels. OpenEXR allocates by all of these before it looks for them. Whether the headers
/// are right otherwise is left to OpenEXR.
void check_exr_header(const std::filesystem::path& path);

}  // namespace treefarm
