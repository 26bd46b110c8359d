// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <sstream>

#include "cli/commands.h"
#include "cli/inspect_output.h"
#include "cli/option_values.h"
#include "common/base/files/atomic_file.h"
#include "common/base/host.h"
#include "common/decide/next_event/next_event_sums.h"
#include "common/image/png.h"
#include "common/metrics/false_colour.h"
#include "common/runs/run_files.h"
#include "worker/tools/inspect_film.h"

namespace treefarm {

namespace {

struct InspectOptions {
    std::string directory;
    std::vector<std::string> pixels, points;
    bool maps = false, json = false;
    int size = 64;
    std::uint32_t spp = 256;
    unsigned threads = 0;
    std::string output;
};

int bits_of(int size) {
    int bits = 0;
    while (1 << bits < size)
        ++bits;
    if (1 << bits != size)
        throw InputError(Location{"--size", 0, 0}, std::to_string(size) + " is no power of two",
                         "give 16, 32, 64, 128 or 256");
    return bits;
}

/// Writes a map of values from 0 to `white`.
MapReport write_map(const std::string& kind, Plane map, double white, const std::filesystem::path& folder) {
    MapReport report{kind, (folder / ("map-" + kind + ".png")).string(), white, 0};
    std::size_t count = 0;
    for (float& value : map.values) {
        if (std::isnan(value)) continue;
        report.mean += static_cast<double>(value);
        ++count;
        value = static_cast<float>(static_cast<double>(value) / white);
    }
    if (count > 0) report.mean /= static_cast<double>(count);
    write_file_atomically(report.file, encode_png(false_colour(map)));
    return report;
}

std::vector<MapReport> write_maps(const TraceScene& scene, const AnyModel& tree, const AnySampler& guide,
                                  const std::filesystem::path& folder) {
    FilmMaps maps = film_maps(scene, tree, guide);
    float most = 1.0f;
    for (const float cells : maps.cells.values)
        if (cells > most) most = cells;
    const std::filesystem::path regions = folder / "map-regions.png";
    write_file_atomically(regions, encode_png(maps.regions));
    return {{"regions", regions.string(), 0, 0},
            write_map("bsdf-fraction", std::move(maps.bsdf_fraction), 1.0, folder),
            write_map("view-fraction", std::move(maps.view_fraction), 1.0, folder),
            write_map("cells", std::move(maps.cells), static_cast<double>(most), folder)};
}

std::filesystem::path picture_folder(const InspectOptions& options) {
    const std::filesystem::path folder = options.output.empty()
                                             ? std::filesystem::path(options.directory) / kInspectFolder
                                             : std::filesystem::path(options.output);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw InputError(Location{folder.string(), 0, 0}, "cannot hold pictures: " + error.message(),
                         "name another folder with -o");
    return folder;
}

/// Fraction of the regions by number of light samples.
std::vector<double> next_event_parts(const RegionModel& regions) {
    if (!regions.decides_next_event()) return {};
    std::vector<double> parts(kNextEventSamples.size());
    for (const std::uint8_t code : regions.next_event)
        parts[code] += 1.0 / regions.leaf_count();
    return parts;
}

void look(const InspectOptions& options, const InspectedRun& run, InspectReport& report) {
    const AnySampler guide(run.tree);
    const TraceScene scene(run.request.content.scene, run.request.content.plan.job);
    std::vector<NamedPoint> points;  // all of them are parsed before any is traced
    for (const std::string& pixel : options.pixels)
        points.push_back(named_pixel(pixel, scene, guide));
    for (const std::string& point : options.points)
        points.push_back(named_point(point, guide));
    const std::filesystem::path folder = picture_folder(options);
    const BruteForce settings{bits_of(options.size), options.spp,
                              options.threads == 0 ? affinity_threads() : options.threads, run.taught_by_next_event};
    for (const NamedPoint& point : points)
        report.points.push_back(inspect_point(point, run, scene, guide, settings, folder));
    if (options.maps) report.maps = write_maps(scene, run.tree, guide, folder);
    std::ostringstream json;  // a study's page shows the pictures by it
    print_json(report, json);
    const std::string text = json.str();
    write_file_atomically(folder / "inspect.json", {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

void inspect_run(const InspectOptions& options, std::ostream& out) {
    bits_of(options.size);
    const InspectedRun run = read_inspected_run(options.directory);
    InspectReport report;
    report.directory = options.directory;
    report.statistics = run.tree.statistics(run.tree_bytes);
    report.next_event = next_event_parts(run.tree.regions());
    if (options.maps || !options.pixels.empty() || !options.points.empty()) look(options, run, report);
    options.json ? print_json(report, out) : print_text(report, out);
}

}  // namespace

void add_inspect_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto options = std::make_shared<InspectOptions>();
    CLI::App* command = app.add_subcommand("inspect", "Shows the tree that a run learned");
    command->add_option("run", options->directory, "run directory of a guided render")->required();
    command->add_flag("--json", options->json, "print JSON instead of text");
    add_texts_option(*command, "--pixel", options->pixels,
                     "X,Y: pictures of the learned distribution at the surface that this pixel sees");
    add_texts_option(*command, "--point", options->points, "x,y,z or x,y,z:nx,ny,nz: the same at a point of the scene");
    command->add_flag("--maps", options->maps, "pictures over the film: regions, mixtures, memory");
    add_integer_option(*command, "--size", options->size, {16, 256, "squares, a power of two", "64"},
                       "squares along a side of the direction square (default: 64)");
    add_integer_option(*command, "--spp", options->spp, {1, 1 << 20, "paths per square", "256"},
                       "paths per square for the true distribution (default: 256)");
    add_threads_option(*command, options->threads, "tracing threads (default: the processors)");
    add_text_option(*command, "-o,--output", options->output, "folder of the pictures (default: inspect in the run's)");
    command->callback([options, launch, &exit_code] {
        if (launch.rank != 0) return;  // under mpirun one process is enough
        inspect_run(*options, std::cout);
        exit_code = 0;
    });
}

}  // namespace treefarm
