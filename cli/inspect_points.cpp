// SPDX-License-Identifier: Apache-2.0
#include "cli/inspect_points.h"

#include <algorithm>
#include <cmath>

#include "common/base/files/atomic_file.h"
#include "common/base/text/parse_text.h"
#include "common/image/png.h"
#include "common/metrics/false_colour.h"

namespace treefarm {

namespace {

constexpr double kDecades = 3;                          ///< decades of the false-colour scale, below white
constexpr int kPanelPixels = 256;                       ///< least side of a panel
constexpr int kGap = 8;                                 ///< gap between panels
constexpr double kSphere = 4 * 3.14159265358979323846;  ///< steradians

/// Numbers separated by commas; empty if any is invalid.
std::vector<double> numbers_in(const std::string& text) {
    std::vector<double> numbers;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size());
        const auto number = parse_number(text.substr(at, end - at));
        if (!number) return {};
        numbers.push_back(*number);
        at = end + 1;
    }
    return numbers;
}

Vec3 vector_of(const std::vector<double>& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// One density of a picture.
struct Panel {
    std::string title;
    std::vector<float> density;  ///< per steradian; integrates to one unless all are 0
};

/// Integral over the sphere of directions.
double integral_of(const std::vector<float>& values) {
    double sum = 0;
    for (const float value : values)
        sum += static_cast<double>(value);
    return values.empty() ? 0.0 : sum * kSphere / static_cast<double>(values.size());
}

std::vector<float> normalized(std::vector<float> values) {
    const double integral = integral_of(values);
    if (integral > 0)
        for (float& value : values)
            value = static_cast<float>(static_cast<double>(value) / integral);
    return values;
}

double overlap(const Panel& a, const Panel& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.density.size(); ++i)
        sum += static_cast<double>(std::min(a.density[i], b.density[i]));
    return sum * kSphere / static_cast<double>(a.density.size());
}

double most(const std::vector<Panel>& panels) {
    float most = 0;
    for (const Panel& panel : panels)
        most = std::max(most, *std::max_element(panel.density.begin(), panel.density.end()));
    return static_cast<double>(most);
}

/// Panels side by side on one logarithmic scale that ends at `white`. v grows downwards.
RgbImage picture(const std::vector<Panel>& panels, int bits, double white) {
    const int side = 1 << bits, zoom = std::max(1, kPanelPixels / side), edge = side * zoom;
    const int count = static_cast<int>(panels.size());
    RgbImage image(count * edge + (count - 1) * kGap, edge, Rgb(0.2f));
    for (int k = 0; k < count; ++k) {
        Plane plane(side, side);
        for (std::size_t i = 0; i < plane.values.size(); ++i) {
            const double value = static_cast<double>(panels[static_cast<std::size_t>(k)].density[i]);
            plane.values[i] = value > 0 ? static_cast<float>(1 + std::log10(value / white) / kDecades) : 0.0f;
        }
        const RgbImage colours = false_colour(plane);
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x)
                image.pixels[static_cast<std::size_t>(y * image.width + k * (edge + kGap) + x)] =
                    colours.pixels[static_cast<std::size_t>(y / zoom * side + x / zoom)];
    }
    return image;
}

GuidanceComparison compare(const std::string& kind, const std::vector<Panel>& panels, int bits,
                           const std::filesystem::path& file) {
    GuidanceComparison comparison{kind, overlap(panels[0], panels[1]), most(panels), file.string(), {}};
    for (const Panel& panel : panels)
        comparison.panels.push_back(panel.title);
    write_file_atomically(file, encode_png(picture(panels, bits, comparison.white)));
    return comparison;
}

/// Panels of the learned density, of its true target and, if next event removes a part of it, of the whole.
std::vector<Panel> panels_of(const std::string& title, std::vector<float> learned, const std::string& true_title,
                             const std::vector<float>& all, const std::vector<float>& left) {
    std::vector<Panel> panels = {{title, normalized(std::move(learned))}};
    if (!left.empty() && left != all) panels.push_back({true_title + " left by next event", normalized(left)});
    panels.push_back({true_title, normalized(all)});
    return panels;
}

}  // namespace

NamedPoint named_pixel(const std::string& text, const TraceScene& scene, const AnySampler& guide) {
    const Location where{"--pixel " + text, 0, 0};
    const std::vector<double> at = numbers_in(text);
    const int width = scene.film().width, height = scene.film().height;
    const auto pixel = [](double v, int size) { return v >= 0 && v < size && v == std::floor(v); };
    if (at.size() != 2 || !pixel(at[0], width) || !pixel(at[1], height))
        throw InputError(
            where, "is no pixel of the image",
            "write X,Y from 0,0 at the top left to " + std::to_string(width - 1) + "," + std::to_string(height - 1));
    const int x = static_cast<int>(at[0]), y = static_cast<int>(at[1]);
    const auto point = seen_point(scene, x, y);
    if (!point) throw InputError(where, "sees no surface, so there is nothing to guide", "choose another pixel");
    const PointFacts facts = point_facts(scene, guide, *point);
    if (facts.black || !facts.smooth)
        throw InputError(where,
                         facts.black ? "sees a surface that reflects nothing, so there is nothing to guide"
                                     : "sees a mirror or smooth glass, which no tree guides",
                         "choose another pixel");
    return {"pixel-" + std::to_string(x) + "-" + std::to_string(y), "pixel " + text, *point};
}

NamedPoint named_point(const std::string& text, const AnySampler& guide) {
    const Location where{"--point " + text, 0, 0};
    const std::size_t colon = text.find(':');
    const std::vector<double> at = numbers_in(text.substr(0, colon));
    const std::vector<double> normal = colon == std::string::npos ? at : numbers_in(text.substr(colon + 1));
    if (at.size() != 3 || normal.size() != 3)
        throw InputError(where, "is no point", "write x,y,z or, with a normal, x,y,z:nx,ny,nz");
    NamedPoint named{"point-" + text, "point " + text, {}};
    std::replace(named.name.begin(), named.name.end(), ',', '_');
    std::replace(named.name.begin(), named.name.end(), ':', '-');
    std::replace(named.name.begin(), named.name.end(), ' ', '_');
    Hit& hit = named.point.hit;
    hit.p = vector_of(at);
    if (!guide.regions().contains(hit.p))
        throw InputError(where, "is outside of the cube that the tree divides",
                         "give a point of the scene, in its world's coordinates");
    if (colon == std::string::npos) return named;
    hit.ng = vector_of(normal);
    if (const float squared = dot(hit.ng, hit.ng); !(squared > 0.0f) || !std::isfinite(squared))
        throw InputError(where, "has a normal without direction", "give one, like 0,1,0");
    hit.ng = hit.ns = normalize(hit.ng);
    hit.error = offset_bound(std::max({std::abs(hit.p.x), std::abs(hit.p.y), std::abs(hit.p.z)}));
    named.point.normal = true;
    return named;
}

PointReport inspect_point(const NamedPoint& named, const InspectedRun& run, const TraceScene& scene,
                          const AnySampler& guide, const BruteForce& settings, const std::filesystem::path& folder) {
    PointReport report{named.text, named.point.hit.p, point_facts(scene, guide, named.point), 0.0, {}};
    const PointGuidance& guidance = report.facts.guidance;
    const PointTruth truth = trace_point(scene, run.request.content.plan.job, guide, named.point, settings);
    report.reflected = integral_of(truth.reflected);
    const auto add = [&](const std::string& kind, const std::vector<Panel>& panels) {
        report.comparisons.push_back(compare(kind, panels, settings.bits, folder / (named.name + "-" + kind + ".png")));
    };
    add("t1", panels_of("T1", run.tree.density_map(guidance.region, settings.bits), "incident radiance", truth.radiance,
                        truth.left));
    if (guidance.has_view()) {
        const bool product = run.request.content.job.guiding.view_records == ViewRecords::product;
        add("t2", panels_of("T2", run.tree.density_map(guidance.view, settings.bits),
                            product ? "f cos L" : "incident radiance", product ? truth.reflected : truth.radiance,
                            product ? truth.left_reflected : truth.left));
    }
    if (named.point.surface)
        add("sampled", panels_of("what is sampled", truth.sampled, "f cos L", truth.reflected, truth.left_reflected));
    return report;
}

}  // namespace treefarm
