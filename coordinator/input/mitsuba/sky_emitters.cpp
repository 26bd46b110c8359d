// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "common/base/text/parse_text.h"
#include "coordinator/input/colour/daylight.h"
#include "coordinator/input/colour/hosek_wilkie.h"
#include "coordinator/input/mitsuba/emitters.h"

namespace treefarm::mitsuba {
namespace {

using Rgb64 = Imath::Color3<double>;
using Vec64 = Imath::V3d;

struct SkySettings {
    bool sky = true, sun = true;
    bool of_mitsuba_3 = false;
    double turbidity = 3.0;
    Rgb64 albedo = Rgb64(0.0);  ///< of the ground
    double stretch = 1.0;       ///< extent of the sky, from 1 (the upper half) to 2 (all directions)
    bool extend = false;        ///< the horizon's radiance continues below it, fading
    double sky_scale = 1.0, sun_scale = 1.0;
    double sun_radius_scale = 1.0;  ///< factor on the sun's radius at constant irradiance
    int resolution = 512;           ///< pixels around the horizon; half as many from pole to pole
    SkyAngles position;             ///< of the sun
};

double number_within(Properties& properties, const char* name, double otherwise, double least, double most) {
    const double value = properties.number(name, otherwise);
    if (!(value >= least && value <= most))
        throw InputError(properties.where(name), std::string(name) + " of " + number_text(value),
                         "give " + number_text(least) + " to " + number_text(most));
    return value;
}

int integer_within(Properties& properties, const char* name, int otherwise, int least, int most) {
    const std::int64_t value = properties.integer(name, otherwise);
    if (value < least || value > most)
        throw InputError(properties.where(name), std::string(name) + " of " + std::to_string(value),
                         "give " + std::to_string(least) + " to " + std::to_string(most));
    return static_cast<int>(value);
}

/// Direction in the frame of the environment's image: y up, u from -z over x.
Vec64 direction_of(const SkyAngles& angles) {
    const double sine = std::sin(angles.zenith);
    return {std::sin(angles.azimuth) * sine, std::cos(angles.zenith), -std::cos(angles.azimuth) * sine};
}

SkyAngles angles_of(const Vec64& direction) {
    return {std::acos(std::clamp(direction.y, -1.0, 1.0)), std::atan2(direction.x, -direction.z)};
}

SkyAngles read_position(Properties& properties, const EnvironmentEmitter& frame) {
    constexpr const char* kObservation[] = {"year",   "month",    "day",       "hour",    "minute",
                                            "second", "latitude", "longitude", "timezone"};
    if (properties.has("sun_direction")) {
        for (const char* name : kObservation)
            if (properties.has(name))
                throw InputError(properties.where(name), "both the sun's direction and a time or place are given",
                                 "keep one of them");
        const Vec3 world = properties.point("sun_direction", Vec3(0.0f, 1.0f, 0.0f));
        const Vec64 local(dot(world, frame.x_axis), dot(world, frame.y_axis), dot(world, frame.z_axis));
        if (!(local.length() > 0.0) || !is_finite(world))
            throw InputError(properties.where("sun_direction"), "the direction has no length", "give another");
        return angles_of(local.normalized());
    }
    Observation at;
    at.year = integer_within(properties, "year", at.year, 1600, 2600);
    at.month = integer_within(properties, "month", at.month, 1, 12);
    at.day = integer_within(properties, "day", at.day, 1, 31);
    at.hour = number_within(properties, "hour", at.hour, -48.0, 48.0);
    at.minute = number_within(properties, "minute", at.minute, 0.0, 60.0);
    at.second = number_within(properties, "second", at.second, 0.0, 60.0);
    at.latitude = number_within(properties, "latitude", at.latitude, -90.0, 90.0);
    at.longitude = number_within(properties, "longitude", at.longitude, -180.0, 180.0);
    at.timezone = number_within(properties, "timezone", at.timezone, -14.0, 14.0);
    return sun_position(at);
}

SkySettings read_settings(Properties& properties, const EnvironmentEmitter& frame, TextureReader& textures) {
    constexpr double kMost = 1e15;
    SkySettings sky;
    const std::string type = properties.type();
    sky.sky = type != "sun";
    sky.sun = type != "sky";
    sky.turbidity = number_within(properties, "turbidity", 3.0, 1.0, 10.0);
    sky.of_mitsuba_3 = properties.element().version >= 2;
    if (sky.of_mitsuba_3) {
        sky.sky_scale = number_within(properties, "sky_scale", 1.0, 0.0, kMost);
        sky.sun_scale = number_within(properties, "sun_scale", 1.0, 0.0, kMost);
        constexpr double kAperture = 2.0 * kSunRadius * 180.0 / M_PI;
        sky.sun_radius_scale = number_within(properties, "sun_aperture", kAperture, 1e-3, 60.0) / kAperture;
        properties.ignore({"complex_sun"});
    } else {
        const double scale = number_within(properties, "scale", 1.0, 0.0, kMost);
        sky.sky_scale = type == "sunsky" ? number_within(properties, "sky_scale", scale, 0.0, kMost) : scale;
        sky.sun_scale = type == "sunsky" ? number_within(properties, "sun_scale", scale, 0.0, kMost) : scale;
        sky.stretch = number_within(properties, "stretch", 1.0, 1.0, 2.0);
        sky.resolution = integer_within(properties, "resolution", 512, 4, 4096);
        if (sky.sky) sky.extend = properties.boolean("extend", false);
        if (sky.sun) sky.sun_radius_scale = number_within(properties, "sun_radius_scale", 1.0, 0.0, 100.0);
    }
    if (sky.sky) {
        // 0.6 has 0.2 in its code, though its manual says 0.15.
        const Rgb otherwise(sky.of_mitsuba_3 ? 0.3f : 0.2f);
        sky.albedo = Rgb64(textures.constant(properties, "albedo", otherwise, ColorUse::reflectance));
    }
    sky.position = read_position(properties, frame);
    if (sky.position.zenith > M_PI / 2.0)
        throw InputError(properties.where(), "the sun is below the horizon, where the model of the sky ends",
                         "choose a time of day with sun, or another direction");
    return sky;
}

void paint_sky(const SkySettings& settings, TextureImage& image) {
    const HosekWilkieSky model(settings.turbidity, settings.albedo, M_PI / 2.0 - settings.position.zenith);
    // Integral of the CIE 1931 ybar over the wavelength in nm, as used by each version.
    const double per_nm = 1.0 / (settings.of_mitsuba_3 ? 106.7502593994140625 : 106.856980);
    const Vec64 sun = direction_of(settings.position);
    for (int y = 0; y < image.height; ++y) {
        const double below_pole = (y + 0.5) * M_PI / image.height;
        double zenith = below_pole / settings.stretch;
        double fade = 1.0;
        if (settings.extend) {
            const double t = std::clamp(2.0 - 2.0 * below_pole / M_PI, 0.0, 1.0);
            fade = t * t * (3.0 - 2.0 * t);
        }
        if (zenith >= M_PI / 2.0) {
            if (!settings.extend) return;
            zenith = M_PI / 2.0 - 1e-4;
        }
        for (int x = 0; x < image.width; ++x) {
            const Vec64 direction = direction_of({zenith, (x + 0.5) * 2.0 * M_PI / image.width});
            const double from_sun = std::acos(std::clamp(direction.dot(sun), -1.0, 1.0));
            const Rgb64 radiance = model.radiance(zenith, from_sun) * (per_nm * settings.sky_scale * fade);
            float* pixel = &image.floats[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                              static_cast<std::size_t>(x))];
            for (int c = 0; c < 3; ++c)
                pixel[c] = static_cast<float>(radiance[c]);
        }
    }
}

/// Adds a disk of `radius` (radians) to the image such that its irradiance on a facing plane is `irradiance`; each
/// pixel gets the share that falls on it.
void paint_sun(const SkyAngles& position, double radius, const Rgb64& irradiance, TextureImage& image) {
    // Points of equal solid angle on the disk, in a spiral: more than enough for every pixel that it touches.
    const double cos_radius = std::cos(radius);
    const double pixel = M_PI / image.height;
    const double covered = 2.0 * M_PI * (1.0 - cos_radius) / (pixel * pixel);
    const auto count = static_cast<std::size_t>(std::clamp(1000.0 * covered, 1000.0, 4e6));
    const Vec64 axis = direction_of(position);
    const Vec64 side = (std::abs(axis.y) < 0.9 ? Vec64(0, 1, 0) : Vec64(1, 0, 0)).cross(axis).normalized();
    const Vec64 other = axis.cross(side);
    const double golden = M_PI * (3.0 - std::sqrt(5.0));
    for (std::size_t i = 0; i < count; ++i) {
        const double cosine = 1.0 - (static_cast<double>(i) + 0.5) / static_cast<double>(count) * (1.0 - cos_radius);
        const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
        const double turn = golden * static_cast<double>(i);
        const Vec64 direction = axis * cosine + (side * std::cos(turn) + other * std::sin(turn)) * sine;
        const SkyAngles at = angles_of(direction);
        const double u = at.azimuth / (2.0 * M_PI);
        const int x = std::clamp(static_cast<int>((u - std::floor(u)) * image.width), 0, image.width - 1);
        const int y = std::clamp(static_cast<int>(at.zenith / M_PI * image.height), 0, image.height - 1);
        const double solid_angle = (std::cos(y * pixel) - std::cos((y + 1) * pixel)) * 2.0 * M_PI / image.width;
        float* target = &image.floats[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                                           static_cast<std::size_t>(x))];
        for (int c = 0; c < 3; ++c)
            target[c] += static_cast<float>(irradiance[c] / (solid_angle * static_cast<double>(count)));
    }
}

/// Irradiance of the sun on a plane facing it, W / (m^2 nm), by the model of the version that the file is for.
Rgb64 sun_irradiance(const SkySettings& settings) {
    if (settings.of_mitsuba_3)
        return hosek_wilkie_sun(settings.turbidity, M_PI / 2.0 - settings.position.zenith) * settings.sun_scale;
    const double solid_angle = 2.0 * M_PI * (1.0 - std::cos(kSunRadius));
    return preetham_sun(settings.turbidity, settings.position.zenith) * (solid_angle * settings.sun_scale);
}

/// Axes of the image: version 0.6 has y up, north at -z and east at x; version 3 has z up, south at x and west at y
/// (its sun_coordinates turns the azimuth by pi, though its documentation says that x is north).
EnvironmentEmitter read_frame(Properties& properties) {
    EnvironmentEmitter frame = read_environment_axes(properties);
    if (properties.element().version < 2) return frame;
    EnvironmentEmitter turned = frame;
    turned.x_axis = -frame.y_axis;
    turned.y_axis = frame.z_axis;
    turned.z_axis = frame.x_axis;
    return turned;
}

}  // namespace

void read_sky(Properties& properties, Scene& scene, TextureReader& textures) {
    EnvironmentEmitter environment = read_frame(properties);
    const SkySettings settings = read_settings(properties, environment, textures);

    TextureImage image;
    image.name = properties.type();
    image.width = settings.resolution;
    image.height = std::max(settings.resolution / 2, 1);
    image.channels = 3;
    image.floats.resize(3 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    if (settings.sky) paint_sky(settings, image);
    if (settings.sun) {
        const Rgb64 irradiance = sun_irradiance(settings);
        const SkyAngles stretched{settings.position.zenith * settings.stretch, settings.position.azimuth};
        if (settings.sun_radius_scale == 0.0) {
            const Vec64 sun = direction_of(stretched);
            const Vec3 towards = environment.x_axis * static_cast<float>(sun.x) +
                                 environment.y_axis * static_cast<float>(sun.y) +
                                 environment.z_axis * static_cast<float>(sun.z);
            const Rgb parallel(static_cast<float>(irradiance.x), static_cast<float>(irradiance.y),
                               static_cast<float>(irradiance.z));
            scene.emitters.push_back({DirectionalEmitter{-normalize(towards), parallel}, properties.where()});
            if (!settings.sky) return;
        } else {
            paint_sun(stretched, kSunRadius * settings.sun_radius_scale, irradiance, image);
        }
    }
    environment.image = static_cast<std::int32_t>(scene.images.size());
    scene.images.push_back(std::move(image));
    scene.emitters.push_back({environment, properties.where()});
}

}  // namespace treefarm::mitsuba
