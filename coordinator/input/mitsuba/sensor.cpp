// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/sensor.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/base/text/parse_text.h"
#include "coordinator/input/mitsuba/field_of_view.h"

namespace treefarm::mitsuba {
namespace {

constexpr std::string_view kSensors[] = {"perspective", "thinlens", "orthographic", "spherical"};

double radians(double degrees) {
    return degrees * M_PI / 180.0;
}

/// Reads a sampler. Random numbers are always Treefarm's own.
void read_sampler(const XmlElement& sampler, std::vector<Setting>& settings, const SceneDocument& document,
                  Diagnostics& diagnostics) {
    Properties properties(sampler, document, diagnostics);
    properties.type();
    if (properties.has("sample_count"))
        settings.push_back(
            {"budget.spp", std::to_string(properties.integer("sample_count", 0)), properties.where("sample_count")});
    if (properties.has("seed"))
        settings.push_back({"sampler.seed", std::to_string(properties.integer("seed", 0)), properties.where("seed")});
    properties.ignore({"scramble", "dimension", "jitter", "strength"});
    properties.finish();
}

/// Turns the pinhole into a disk and moves the film's image to the plane of focus, where points are sharp.
void add_lens(Properties& properties, const Matrix& to_world, Camera& camera, Diagnostics& diagnostics) {
    if (!properties.has("aperture_radius"))
        throw InputError(properties.where(), properties.title() + " has no aperture",
                         R"(add <float name="apertureRadius" value="..."/>, or use perspective)");
    const double radius = properties.number("aperture_radius", 0.0);
    if (!(radius >= 0.0))
        throw InputError(properties.where("aperture_radius"), "an aperture radius of " + number_text(radius),
                         "give 0 or more");
    if (radius == 0.0) diagnostics.warn(properties.where("aperture_radius"), "an aperture without extent is a pinhole");
    const double focus = properties.positive("focus_distance", properties.number("far_clip", 1e4));
    const auto distance = static_cast<float>(focus), size = static_cast<float>(radius);
    camera.corner *= distance;
    camera.across *= distance;
    camera.down *= distance;
    camera.lens_u = transform_vector(to_world, Vec3(size, 0.0f, 0.0f));
    camera.lens_v = transform_vector(to_world, Vec3(0.0f, size, 0.0f));
}

/// Whether a matrix preserves three dimensions.
bool is_invertible(const Matrix& m) {
    const Imath::V3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
    const double volume = std::abs(x.cross(y).dot(z));
    return volume > 1e-9 * x.length() * y.length() * z.length() && std::isfinite(volume);
}

/// Orthographic camera: the film covers [-1, 1] along its x axis, scaled by to_world.
Camera orthographic_camera(const Matrix& to_world, double aspect) {
    const auto direction = [&](double x, double y, double z) {
        Imath::V3d result;
        to_world.multDirMatrix(Imath::V3d(x, y, z), result);
        return result;
    };
    Camera camera;
    camera.origin = transform_point(to_world, Vec3(0.0f));
    camera.corner = Vec3(direction(1.0, 1.0 / aspect, 0.0));
    camera.across = Vec3(direction(-2.0, 0.0, 0.0));
    camera.down = Vec3(direction(0.0, -2.0 / aspect, 0.0));
    camera.parallel = Vec3(direction(0.0, 0.0, 1.0).normalized());
    return camera;
}

Camera read_orthographic(Properties& properties, double aspect) {
    const Matrix to_world = properties.transform("to_world");
    if (!is_invertible(to_world))
        throw InputError(properties.where("to_world"), "the camera's transformation takes away a dimension",
                         "scale by numbers other than 0");
    return orthographic_camera(to_world, aspect);
}

/// Panorama of all directions: longitude across, from behind over the left to the front in the middle, and latitude
/// down (Mitsuba 0.6's `spherical`).
Camera read_spherical(Properties& properties) {
    const Matrix to_world = properties.transform("to_world");
    if (std::abs(uniform_scale(to_world, 1e-3) - 1.0) > 1e-3)
        throw InputError(properties.where("to_world"), "the camera's transformation contains a scale or shear",
                         "remove it: only rotations, mirrors and translations can move a camera");
    Camera camera;
    camera.origin = transform_point(to_world, Vec3(0.0f));
    camera.across = transform_vector(to_world, Vec3(1.0f, 0.0f, 0.0f)).normalized();
    camera.down = transform_vector(to_world, Vec3(0.0f, 1.0f, 0.0f)).normalized();
    camera.corner = transform_vector(to_world, Vec3(0.0f, 0.0f, 1.0f)).normalized();
    camera.panoramic = true;
    return camera;
}

Camera read_perspective(Properties& properties, const std::string& type, double aspect, Diagnostics& diagnostics) {
    const Matrix to_world = properties.transform("to_world");
    if (std::abs(uniform_scale(to_world, 1e-3) - 1.0) > 1e-3)
        throw InputError(properties.where("to_world"), "the camera's transformation contains a scale or shear",
                         "remove it: only rotations, mirrors and translations can move a camera");
    const double width = read_half_width(properties, aspect);
    const double offset_x = properties.number("principal_point_offset_x", 0.0);
    const double offset_y = properties.number("principal_point_offset_y", 0.0);
    Camera camera = make_camera(to_world, 2.0 * std::atan(width) * 180.0 / M_PI, aspect, offset_x, offset_y);
    if (type == "thinlens") add_lens(properties, to_world, camera, diagnostics);
    return camera;
}

}  // namespace

Camera make_camera(const Matrix& to_world, double horizontal_fov, double aspect, double principal_x,
                   double principal_y) {
    const double width = std::tan(radians(horizontal_fov) / 2.0), height = width / aspect;
    const auto direction = [&](double x, double y, double z) {
        Imath::V3d result;
        to_world.multDirMatrix(Imath::V3d(x, y, z), result);
        return result;
    };
    const Imath::V3d across = direction(-2.0 * width, 0.0, 0.0), down = direction(0.0, -2.0 * height, 0.0);
    const Imath::V3d corner = direction(width, height, 1.0) + across * principal_x + down * principal_y;
    Camera camera;
    camera.origin = transform_point(to_world, Vec3(0.0f));
    camera.corner = Vec3(corner);
    camera.across = Vec3(across);
    camera.down = Vec3(down);
    return camera;
}

void set_default_camera(int version, Scene& scene) {
    Box3 box;
    for (const Shape& shape : scene.shapes)
        if (shape.group == kNone) box.extendBy(own_box(shape));
    Matrix to_world;
    if (!box.isEmpty() && is_finite(box.min) && is_finite(box.max)) {
        const Imath::V3d low(box.min), high(box.max), size = high - low;
        const double width = std::max(std::max(size.x, size.y), version < 2 ? 0.0 : size.z);
        const double distance = width / (2.0 * std::tan(radians(22.5)));
        to_world.setTranslation(Imath::V3d(0.5 * (low.x + high.x), 0.5 * (low.y + high.y), low.z - distance));
    }
    const double aspect = static_cast<double>(scene.film.whole_width()) / scene.film.whole_height();
    scene.camera = make_camera(to_world, 45.0, aspect, 0.0, 0.0);
    scene.camera.passes_hidden_emitters = version >= 2;
}

void read_sensor(const XmlElement& sensor, const FilmSize& wanted, Scene& scene, std::vector<Setting>& settings,
                 const SceneDocument& document, Diagnostics& diagnostics) {
    Properties properties(sensor, document, diagnostics);
    const std::string type = properties.type();
    if (std::find(std::begin(kSensors), std::end(kSensors), type) == std::end(kSensors)) {
        diagnostics.unsupported(sensor.where, "the sensor " + in_quotes(type) + " is not available in this version",
                                did_you_mean(type, kSensors, "use perspective, thinlens, orthographic or spherical"),
                                "it is read as perspective");
        // Properties of other sensors.
        properties.ignore({"aperture_radius", "kc", "scale", "srf"});
    }
    if (properties.number("shutter_close", 0.0) != properties.number("shutter_open", 0.0))
        diagnostics.warn(properties.where("shutter_close"),
                         "the shutter stays open for a while, but nothing moves: no motion is simulated");
    scene.film = read_film(properties.only_child("film"), wanted, sensor.version, settings, document, diagnostics);
    if (const XmlElement* sampler = properties.only_child("sampler"))
        read_sampler(*sampler, settings, document, diagnostics);

    const double aspect = static_cast<double>(scene.film.whole_width()) / scene.film.whole_height();
    scene.camera = type == "orthographic" ? read_orthographic(properties, aspect)
                   : type == "spherical"  ? read_spherical(properties)
                                          : read_perspective(properties, type, aspect, diagnostics);
    scene.camera.passes_hidden_emitters = sensor.version >= 2;
    // A pinhole has no focus, and rays need no clipping planes: objects before the near plane are visible.
    properties.ignore({"near_clip", "far_clip", "focus_distance"});
    properties.finish();
}

}  // namespace treefarm::mitsuba
