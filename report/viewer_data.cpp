// SPDX-License-Identifier: Apache-2.0
#include "report/viewer_data.h"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "common/image/exr.h"
#include "common/runs/run_files.h"
#include "report/figure_text.h"
#include "report/html.h"

namespace treefarm {

namespace {

/// Largest side of images in the page, in pixels.
constexpr int kLongestSide = 640;

nlohmann::json viewer_image(const std::string& name, const std::string& caption, const std::filesystem::path& file) {
    const RgbImage image = reduced(read_exr_rgb(file).image, kLongestSide);
    return {{"name", name},
            {"caption", caption},
            {"width", image.width},
            {"height", image.height},
            {"rgbe", base64_rgbe(image)}};
}

std::string caption(const StudyResults& results, const CellResult& cell) {
    const PassRow& last = cell.passes.back();
    const std::string text = fmt::format("{}, {} spp, error {}", time_text(last.run_seconds, false), last.spp_done,
                                         percent_text(results.measured_by.front().value(last)));
    return results.has_references ? text + fmt::format(", FLIP {:.3g}", cell.flip) : text;
}

}  // namespace

std::string viewer_data(const StudyResults& results, const SceneResult& scene) {
    nlohmann::json images = nlohmann::json::array();
    for (const MethodResult& method : results.methods) {
        const auto cells = results.of(scene.name, method.name);
        if (cells.empty()) continue;
        const std::filesystem::path file = cells.front()->folder / kImageFile;
        if (std::filesystem::exists(file))
            images.push_back(viewer_image(method.name, caption(results, *cells.front()), file));
    }
    if (results.has_references)
        images.push_back(
            viewer_image("reference", scene.reference_rendered ? "rendered" : "given", scene.reference_file));
    if (images.empty()) return "";
    std::string json =
        images.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);  // a text in a script would end at "</"
    for (std::size_t at = 0; (at = json.find("</", at)) != std::string::npos; at += 3)
        json.replace(at, 2, "<\\/");
    return R"(<div class="viewer"><script type="application/json">)" + json + "</script></div>\n";
}

}  // namespace treefarm
