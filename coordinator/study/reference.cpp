// SPDX-License-Identifier: Apache-2.0
#include "coordinator/study/reference.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "common/base/hash.h"
#include "common/image/exr.h"
#include "common/runs/run_json.h"

namespace treefarm {

namespace {

namespace fs = std::filesystem;

/// Throws InputError unless cells of this film can be compared with the image.
void check_given(const RgbImage& image, const Film& film, const Location& where) {
    if (image.width != film.width || image.height != film.height)
        throw InputError(where,
                         fmt::format("the reference has {} x {} pixels, the scene {} x {}", image.width, image.height,
                                     film.width, film.height),
                         "set image.width and image.height, or render another reference");
    const auto finite = [](const Rgb& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); };
    const auto bad =
        image.pixels.size() - static_cast<std::size_t>(std::count_if(image.pixels.begin(), image.pixels.end(), finite));
    if (bad > 0)
        throw InputError(where, fmt::format("the reference has {} pixels that are no finite numbers", bad),
                         "render another reference");
}

}  // namespace

bool Reference::is_there() const {
    return !read_run_json(mark()).empty() && is_exr_file(file);
}

std::string reference_key(const Study& study, const StudyScene& scene, const LoadedScene& loaded, Reference& reference,
                          RenderRequest& request, const RenderOrigin& origin) {
    if (!scene.reference.empty()) {
        ExrRgb given = read_exr_rgb(scene.reference);
        const Film& film = loaded.scene.film;
        // An image of the whole film also fits a crop window.
        if (film.crop.is_window() && given.image.width == film.whole_width() &&
            given.image.height == film.whole_height())
            given.image = cut_out(given.image, film.crop, film.width, film.height);
        check_given(given.image, loaded.scene.film, scene.reference_where);
        reference.file = scene.reference;
        reference.image = given.image;
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(given.image.pixels.data());
        return hash_text(hash_bytes({bytes, given.image.pixels.size() * sizeof(Rgb)}));
    }
    request = study_request(study, scene, loaded, study.reference.settings, {}, origin);
    const std::uint64_t key = request_key(request, "reference");
    reference.file = (fs::path(study.directory) / "references" / folder_name(scene.name, key) / kImageFile).string();
    return hash_text(key);
}

}  // namespace treefarm
