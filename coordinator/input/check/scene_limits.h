// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "common/base/error.h"
#include "common/config/job.h"

namespace treefarm {

/// Limits of the files and sizes of a scene from an untrusted source.
struct SceneLimits {
    std::filesystem::path root{};        ///< folder that must contain all files, links followed; empty: no limit
    std::uint64_t file_bytes = ~0ull;    ///< of one file
    std::uint64_t image_pixels = ~0ull;  ///< of one image
    std::uint64_t triangles = ~0ull;     ///< of all meshes

    /// Throws InputError if a file may not be read. Its existence is not checked.
    void check_file(const std::filesystem::path& file, const Location& where) const;
    /// Throws InputError if a scene with so many triangles is too large.
    void check_triangles(std::uint64_t count, const Location& where) const;
};

SceneLimits scene_limits(const Job::SceneSource& source);

}  // namespace treefarm
