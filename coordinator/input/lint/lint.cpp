// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/lint/lint.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace treefarm {
namespace linting {

std::string named(const std::string& kind, const std::string& name) {
    return name.empty() ? "the " + kind : kind + " \"" + name + "\"";
}

std::string short_number(double value) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.4g", value);
    return text;
}

namespace {

using enum Finding::Severity;

/// Box of the finite coordinates.
Box3 finite_bounds(const Scene& scene) {
    Box3 box;
    for (const Shape& shape : scene.shapes)
        if (const auto* mesh = std::get_if<Mesh>(&shape.geometry)) {
            for (const Vec3& p : mesh->positions)
                if (is_finite(p)) box.extendBy(p);
        } else if (const Box3 own = own_box(shape); !own.isEmpty() && is_finite(own.min) && is_finite(own.max)) {
            box.extendBy(own);
        }
    return box;
}

/// Distance from the origin, in sizes of a shape, at which its floats lose 6 of their 24 bits; equals that of
/// load_scene().
constexpr double kFarSizes = 64.0;

/// Finding about a shape that contains the camera and is far from the origin, relative to the point to which a render
/// moves the scene: positions on it are imprecise, and rays that start in a corner may start behind the other wall. Per
/// size of distance about 2^-25 of the diffuse rays leak (bench/log/scenes.md, "do closed rooms leak").
void lint_camera_surroundings(const Scene& scene, const Imath::V3d& origin, std::vector<Finding>& findings) {
    const Imath::V3d camera(scene.camera.origin);
    const Shape* worst = nullptr;
    double sizes = kFarSizes, farthest = 0;
    for (const Shape& shape : scene.shapes) {
        const Box3 box = own_box(shape);
        if (shape.group != kNone || box.isEmpty() || !is_finite(box.min) || !is_finite(box.max)) continue;
        const Imath::V3d low(box.min), high(box.max);
        double size = 0, away = 0, largest = 0;
        for (int i = 0; i < 3; ++i) {
            size = std::max(size, high[i] - low[i]);
            away = std::max({away, low[i] - camera[i], camera[i] - high[i]});
            largest = std::max({largest, std::abs(low[i] - origin[i]), std::abs(high[i] - origin[i])});
        }
        if (!(size > 0) || away > 2 * size || !(largest > sizes * size)) continue;
        worst = &shape;
        sizes = largest / size;
        farthest = largest;
    }
    if (worst)
        findings.push_back({warning, "far room", worst->where,
                            named("shape", worst->name) + ", at which the camera stands, is " + short_number(sizes) +
                                " of its sizes from the origin: positions on it are blurred by " +
                                short_number(farthest * 0x1p-24) + " units, and about " +
                                short_number(sizes * 0x1p-25) + " of the rays from its corners pass its walls",
                            "set farm.robust = true, under which none does, or move the scene so that it is near"});
}

}  // namespace

/// Findings about missing shapes or emitters, and about the size and the position of the scene: floats have 24 bits, of
/// which a scene far from the origin uses fewer.
void lint_scale(const Scene& scene, std::vector<Finding>& findings) {
    const auto add = [&](Finding::Severity severity, const char* kind, const std::string& what,
                         const std::string& cure) {
        findings.push_back({severity, kind, {}, what, cure});
    };
    if (scene.shapes.empty()) add(warning, "no shapes", "the scene has no shapes", "");
    if (scene.emitters.empty())
        add(warning, "no emitters", "the scene has no emitters: it renders black, unless the integrator needs no light",
            "");
    const Box3 box = finite_bounds(scene);
    if (box.isEmpty()) return;
    const Imath::V3d size = Imath::V3d(box.max) - Imath::V3d(box.min);
    const Imath::V3d middle = (Imath::V3d(box.max) + Imath::V3d(box.min)) * 0.5;
    const double extent = std::max(size.x, std::max(size.y, size.z));
    if (!(extent > 0))
        return add(warning, "no extent", "all of the scene lies at one point", "check its transformations");
    if (middle.length() > 1000 * extent)
        add(warning, "far from origin",
            "the scene lies " + short_number(middle.length() / extent) +
                " of its sizes away from the origin: coordinates that its mesh files hold there are blurred by " +
                short_number(middle.length() * 0x1p-24) + " units",
            "a render moves it to the origin; so should its files");
    lint_camera_surroundings(scene, middle.length() > kFarSizes * extent ? middle : Imath::V3d(0.0), findings);
    if (extent < 1e-3 || extent > 1e6)
        add(note, "scale", "the scene is " + short_number(extent) + " units large",
            "choose units in which rooms are 1 to 1000");
    const Imath::V3d camera(scene.camera.origin);
    if ((camera - middle).length() > 1e4 * extent)
        add(warning, "distant camera",
            "the camera is " + short_number((camera - middle).length() / extent) + " scene sizes away",
            "move it closer, with a wider field of view");
    for (const Shape& shape : scene.shapes) {
        const Box3 own = own_box(shape);
        if (own.isEmpty() || !is_finite(own.min) || !is_finite(own.max)) continue;
        const Vec3 edges = own.max - own.min;
        const auto largest = double(std::max(edges.x, std::max(edges.y, edges.z)));
        if (largest > 0 && largest < 1e-6 * extent && shape.group == kNone)
            findings.push_back(
                {note, "tiny shape", shape.where,
                 named("shape", shape.name) + " is " + short_number(largest / extent) + " of the scene's size",
                 "check its scale"});
    }
}

}  // namespace linting

const char* name_of(Finding::Severity severity) {
    switch (severity) {
        case Finding::Severity::error:
            return "error";
        case Finding::Severity::warning:
            return "warning";
        case Finding::Severity::note:
            break;
    }
    return "note";
}

std::string Finding::text() const {
    const std::string location = where.text();
    return (location.empty() ? "" : location + ": ") + name_of(severity) + ": " + what +
           (cure.empty() ? "" : "; " + cure);
}

std::string Finding::sentence() const {
    const std::string location = where.text();
    return (location.empty() ? "" : location + ": ") + what + (cure.empty() ? "" : "; " + cure);
}

std::vector<Finding> lint(const Scene& scene) {
    std::vector<Finding> findings;
    linting::lint_shapes(scene, findings);
    linting::lint_materials(scene, findings);
    linting::lint_emitters(scene, findings);
    linting::lint_darkness(scene, findings);
    linting::lint_scale(scene, findings);
    return findings;
}

}  // namespace treefarm
