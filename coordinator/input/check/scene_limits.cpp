// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/check/scene_limits.h"

#include <algorithm>
#include <string>

#include "common/base/text/parse_text.h"

namespace treefarm {

namespace fs = std::filesystem;

namespace {

/// Whether a file is below a folder after links are followed.
bool lies_below(const fs::path& file, const fs::path& folder) {
    std::error_code error;
    const fs::path real_folder = fs::canonical(folder, error);
    if (error) return false;
    const fs::path real = fs::weakly_canonical(fs::absolute(file), error);
    if (error) return false;
    return std::mismatch(real_folder.begin(), real_folder.end(), real.begin(), real.end()).first == real_folder.end();
}

}  // namespace

void SceneLimits::check_file(const fs::path& file, const Location& where) const {
    if (!root.empty() && !lies_below(file, root))
        throw InputError(where, path_in_quotes(file.string()) + " does not lie below scene.root",
                         "put the file there, or ask whoever runs this service");
    std::error_code error;
    const std::uintmax_t bytes = fs::is_regular_file(file, error) ? fs::file_size(file, error) : 0;
    if (!error && bytes > file_bytes)
        throw InputError(where,
                         path_in_quotes(file.string()) + " has " + std::to_string(bytes) + " bytes, more than the " +
                             std::to_string(file_bytes) + " of scene.max_file_mb",
                         "reduce it, or raise that");
}

void SceneLimits::check_triangles(std::uint64_t count, const Location& where) const {
    if (count > triangles)
        throw InputError(where,
                         "the scene has " + std::to_string(count) + " triangles up to here, more than the " +
                             std::to_string(triangles) + " of scene.max_triangles",
                         "simplify it, or raise that");
}

SceneLimits scene_limits(const Job::SceneSource& source) {
    SceneLimits limits;
    limits.root = source.root;
    limits.file_bytes = static_cast<std::uint64_t>(source.max_file_mb) * 1'000'000;
    limits.image_pixels = static_cast<std::uint64_t>(source.max_image_megapixels) * 1'000'000;
    if (source.max_triangles > 0) limits.triangles = static_cast<std::uint64_t>(source.max_triangles);
    return limits;
}

}  // namespace treefarm
