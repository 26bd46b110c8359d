// SPDX-License-Identifier: Apache-2.0
#include "cli/inspect_output.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>

namespace treefarm {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kBar = 10;  ///< characters of the longest bar

std::string spread_line(const char* name, const Quantiles& s) {
    return fmt::format("  {:<16}{:>9.3g}{:>9.3g}{:>9.3g}{:>9.3g}{:>9.3g}{:>9.3g}\n", name, s.mean, s.least, s.tenth,
                       s.median, s.nine_tenths, s.most);
}

void print_spreads(const TreeStatistics& s, std::ostream& out) {
    out << fmt::format("  {:<16}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "", "mean", "least", "10 %", "median", "90 %",
                       "most");
    out << spread_line("cells of a T1", s.cells_per_region) << spread_line("regions: a_BSDF", s.regions_mixture.bsdf)
        << spread_line("         a_T1", s.regions_mixture.t1);
    if (s.views == 0) return;
    out << spread_line("views of a T2", s.views_per_t2) << spread_line("cells of a view", s.cells_per_view)
        << spread_line("views: a_BSDF", s.views_mixture.bsdf) << spread_line("       a_T1", s.views_mixture.t1)
        << spread_line("       a_T2", s.views_mixture.t2);
}

/// Prints counts by depth side by side, each with a bar.
void print_depths(const TreeStatistics& s, std::ostream& out) {
    struct Column {
        const char* name;
        const DepthCounts* counts;
    };
    std::vector<Column> columns = {{"regions", &s.region_depth}, {"cells of T1", &s.region_cell_depth}};
    if (s.views != 0) columns.insert(columns.end(), {{"views", &s.view_depth}, {"cells of T2", &s.view_cell_depth}});
    std::size_t rows = 0;
    out << "  depth";
    for (const Column& column : columns) {
        rows = std::max(rows, column.counts->size());
        out << fmt::format("{:>12} {:<{}}", column.name, "", kBar);
    }
    out << '\n';
    for (std::size_t depth = 0; depth < rows; ++depth) {
        std::string line = fmt::format("  {:>5}", depth);
        for (const Column& column : columns) {
            const std::uint32_t count = depth < column.counts->size() ? (*column.counts)[depth] : 0;
            const double fraction = column.counts->empty() ? 0
                                                           : double(count) / *std::max_element(column.counts->begin(),
                                                                                               column.counts->end());
            line += count == 0
                        ? fmt::format("{:>12} {:<{}}", "", "", kBar)
                        : fmt::format("{:>12} {:<{}}", count,
                                      std::string(static_cast<std::size_t>(std::ceil(fraction * kBar)), '#'), kBar);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        if (line.size() > 7) out << line << '\n';
    }
}

void print_point(const PointReport& point, std::ostream& out) {
    const PointGuidance& g = point.facts.guidance;
    out << fmt::format("{}: at ({:.6g}, {:.6g}, {:.6g}), region {}", point.text, point.position.x, point.position.y,
                       point.position.z, g.region);
    if (g.has_view()) out << fmt::format(", distribution {} of its views", g.view);
    out << fmt::format("; a_BSDF {:.3g}, a_T1 {:.3g}, a_T2 {:.3g}", g.bsdf_fraction,
                       1.0f - g.bsdf_fraction - g.view_fraction, g.view_fraction);
    out << (point.reflected > 0 ? fmt::format("; reflects {:.4g}\n", point.reflected) : std::string("\n"));
    for (const GuidanceComparison& c : point.comparisons) {
        std::string panels;
        for (const std::string& panel : c.panels)
            panels += (panels.empty() ? "" : " | ") + panel;
        out << fmt::format("  {}: {}; overlap of the first two {:.1f} %, white {:.3g} per steradian\n", c.file, panels,
                           100 * c.overlap, c.white);
    }
}

Json spread_json(const Quantiles& s) {
    return {{"count", s.count},   {"mean", s.mean},       {"min", s.least}, {"q10", s.tenth},
            {"median", s.median}, {"q90", s.nine_tenths}, {"max", s.most}};
}

Json mixture_json(const MixtureQuantiles& m) {
    return {{"a_bsdf", spread_json(m.bsdf)}, {"a_t1", spread_json(m.t1)}, {"a_t2", spread_json(m.t2)}};
}

Json statistics_json(const TreeStatistics& s) {
    return {{"pass", s.pass + 1},
            {"trained", s.trained},
            {"nodes", s.nodes},
            {"regions", s.regions},
            {"t2s", s.t2s},
            {"views", s.views},
            {"regions_with_t2", s.regions_with_t2},
            {"t2_share", s.t2_share()},
            {"t1_cells", s.region_cells},
            {"t2_cells", s.view_cells},
            {"stored_bytes", s.encoded_bytes},
            {"memory_bytes", s.memory_bytes},
            {"cells_per_region", spread_json(s.cells_per_region)},
            {"views_per_t2", spread_json(s.views_per_t2)},
            {"cells_per_view", spread_json(s.cells_per_view)},
            {"regions_mixture", mixture_json(s.regions_mixture)},
            {"views_mixture", mixture_json(s.views_mixture)},
            {"regions_by_depth", s.region_depth},
            {"t1_cells_by_depth", s.region_cell_depth},
            {"views_by_depth", s.view_depth},
            {"t2_cells_by_depth", s.view_cell_depth}};
}

Json point_json(const PointReport& point) {
    const PointGuidance& g = point.facts.guidance;
    Json json = {{"place", point.text},       {"position", {point.position.x, point.position.y, point.position.z}},
                 {"region", g.region},        {"view", g.has_view() ? Json(g.view) : Json()},
                 {"a_bsdf", g.bsdf_fraction}, {"a_t1", 1.0f - g.bsdf_fraction - g.view_fraction},
                 {"a_t2", g.view_fraction},   {"reflected", point.reflected},
                 {"pictures", Json::array()}};
    for (const GuidanceComparison& c : point.comparisons)
        json["pictures"].push_back(
            Json{{"kind", c.kind}, {"file", c.file}, {"panels", c.panels}, {"overlap", c.overlap}, {"white", c.white}});
    return json;
}

}  // namespace

void print_text(const InspectReport& report, std::ostream& out) {
    const TreeStatistics& s = report.statistics;
    out << fmt::format("{}: the tree that guides pass {}\n", report.directory, s.pass + 1);
    out << fmt::format("  {} regions in {} nodes, {} cells; ", s.regions, s.nodes, s.region_cells);
    out << (s.views == 0 ? std::string("no T2\n")
                         : fmt::format("{} T2s of {} views, {} cells, in {} regions ({:.1f} %)\n", s.t2s, s.views,
                                       s.view_cells, s.regions_with_t2, 100 * s.t2_share()));
    out << fmt::format("  {} bytes stored, {} bytes in memory\n", s.encoded_bytes, s.memory_bytes);
    if (!report.next_event.empty())
        out << fmt::format(
            "  next event at every vertex in {:.0f} % of the regions, at one in 4 in {:.0f} %, in 16 in "
            "{:.0f} %\n",
            100 * report.next_event[0], 100 * report.next_event[1], 100 * report.next_event[2]);
    out << '\n';
    print_spreads(s, out);
    out << '\n';
    print_depths(s, out);
    if (!report.points.empty() || !report.maps.empty()) out << '\n';
    for (const PointReport& point : report.points)
        print_point(point, out);
    for (const MapReport& map : report.maps) {
        out << map.file;
        if (map.white > 0) out << fmt::format(": white {:.4g}, mean {:.4g}", map.white, map.mean);
        out << '\n';
    }
}

void print_json(const InspectReport& report, std::ostream& out) {
    Json json = {{"run", report.directory}, {"tree", statistics_json(report.statistics)}};
    if (!report.next_event.empty()) json["next_event"] = report.next_event;
    json["places"] = Json::array();
    for (const PointReport& point : report.points)
        json["places"].push_back(point_json(point));
    json["maps"] = Json::array();
    for (const MapReport& map : report.maps) {
        json["maps"].push_back(Json{{"kind", map.kind}, {"file", map.file}});
        if (map.white > 0) json["maps"].back().update(Json{{"white", map.white}, {"mean", map.mean}});
    }
    // A path need not be UTF-8.
    out << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
}

}  // namespace treefarm
