// SPDX-License-Identifier: Apache-2.0
#include "coordinator/render/finished_render.h"

#include <algorithm>

#include "common/base/files/atomic_file.h"
#include "common/base/files/read_bytes.h"
#include "common/base/hash.h"
#include "common/image/exr.h"
#include "common/image/png.h"
#include "common/plan/resolve/resolved_file.h"
#include "common/runs/run_json.h"
#include "common/scene/pack/scene_codec.h"

namespace treefarm {

namespace fs = std::filesystem;

RenderFigures read_figures(const fs::path& folder) {
    RenderFigures figures;
    const RunJson summary = read_run_json(folder / kSummaryFile), error = object_of(summary, "image_error");
    figures.spp = static_cast<std::uint32_t>(number_in(summary, "spp"));
    figures.seconds = number_in(summary, "seconds");
    figures.image = folder / kImageFile;
    if (error.contains("relative")) figures.error = number_in(error, "relative");
    figures.missed_target = missed_target(summary);
    return figures;
}

bool holds_result(const fs::path& folder) {
    return text_in(read_run_json(folder / kSummaryFile), "state") == "done" && is_exr_file(folder / kImageFile);
}

bool holds_result_of(const fs::path& folder, const RenderRequest& request) {
    if (!holds_result(folder)) return false;
    const RunJson summary = read_run_json(folder / kSummaryFile);
    return read_text(folder / kJobFile) == job_without_output(request.content.job) &&
           text_in(summary, "fingerprint") == hash_text(request.origin.fingerprint.hash()) &&
           text_in(summary, "scene_hash") == hash_text(content_hash(encode_scene(request.content.scene)));
}

bool restore_output(const fs::path& folder, const std::string& file) {
    std::error_code none;  // an empty file was left by a loss of power
    if (file.empty() || (fs::exists(file) && !(fs::is_regular_file(file) && fs::is_empty(file, none)))) return true;
    const bool is_png = fs::path(file).extension() == ".png";
    if (is_png) {
        const std::vector<std::string> channels = exr_channel_names(folder / kImageFile);
        if (std::find(channels.begin(), channels.end(), "A") != channels.end()) {
            const Image image = read_exr(folder / kImageFile).image;
            const std::span<const float> alpha = alpha_of(image);
            write_output_file(file, encode_png(straight_colours(rgb_layer(image).value(), alpha), 1.0f, alpha));
            return true;
        }
    }
    // The run directory has a copy of a PNG output without alpha, too: the preview.
    const fs::path from = folder / (is_png ? kPreviewFile : kImageFile);
    const std::string bytes = read_text(from);
    if (bytes.empty()) return false;
    write_output_file(file, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    return true;
}

}  // namespace treefarm
