// SPDX-License-Identifier: Apache-2.0
#include "report/tree_pictures.h"

#include <spdlog/fmt/fmt.h>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files/read_bytes.h"
#include "common/runs/run_files.h"
#include "report/html.h"

namespace treefarm {

namespace {

using TreeJson = nlohmann::json;

/// HTML of a picture beside inspect.json, embedded. Only its name counts, since folders may be moved.
std::string figure(const std::filesystem::path& folder, const TreeJson& picture, const std::string& caption) {
    const std::filesystem::path file = folder / std::filesystem::path(picture.at("file").get<std::string>()).filename();
    return R"(<figure><img alt="" src="data:image/png;base64,)" +
           base64(read_bytes(file, "run treefarm inspect again")) + "\"><figcaption>" + html_text(caption) +
           "</figcaption></figure>\n";
}

std::string point_figures(const std::filesystem::path& folder, const TreeJson& point) {
    std::string html;
    for (const TreeJson& picture : point.at("pictures")) {
        std::string panels;
        for (const TreeJson& panel : picture.at("panels"))
            panels += (panels.empty() ? "" : " | ") + panel.get<std::string>();
        html += figure(
            folder, picture,
            fmt::format("{}: {}; overlap {:.0f} %, white {:.3g} per steradian", point.at("place").get<std::string>(),
                        panels, 100 * picture.at("overlap").get<double>(), picture.at("white").get<double>()));
    }
    return html;
}

std::string map_figure(const std::filesystem::path& folder, const TreeJson& map) {
    std::string caption = map.at("kind").get<std::string>();
    if (map.contains("white"))
        caption += fmt::format("; white {:.4g}, mean {:.3g}", map["white"].get<double>(), map["mean"].get<double>());
    return figure(folder, map, caption);
}

std::string cell_pictures(const CellResult& cell, const std::filesystem::path& file) {
    try {
        const TreeJson json = TreeJson::parse(read_text(file));
        const TreeJson& tree = json.at("tree");
        std::string html = fmt::format(
            "<h4>{}</h4>\n<p class=\"note\">{} regions, {} cells of T1; T2 in {:.1f} % of the regions, {} "
            "cells.</p>\n<div class=\"trees\">\n",
            html_text(cell.method), tree.at("regions").get<std::uint64_t>(), tree.at("t1_cells").get<std::uint64_t>(),
            100 * tree.at("t2_share").get<double>(), tree.at("t2_cells").get<std::uint64_t>());
        for (const TreeJson& point : json.at("places"))
            html += point_figures(file.parent_path(), point);
        for (const TreeJson& map : json.at("maps"))
            html += map_figure(file.parent_path(), map);
        return html + "</div>\n";
    } catch (const TreeJson::exception& error) {
        throw InputError(Location{file.string(), 0, 0}, std::string("cannot be read: ") + error.what(),
                         "run treefarm inspect again, or remove it");
    }
}

}  // namespace

std::string tree_pictures(const StudyResults& results, const SceneResult& scene) {
    std::string html;
    for (const MethodResult& method : results.methods)
        for (const CellResult* cell : results.of(scene.name, method.name)) {
            const std::filesystem::path file = cell->folder / kInspectFolder / "inspect.json";
            if (!std::filesystem::exists(file)) continue;
            html += cell_pictures(*cell, file);
            break;
        }
    return html;
}

}  // namespace treefarm
