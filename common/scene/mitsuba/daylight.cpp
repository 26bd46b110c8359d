#include "common/scene/mitsuba/daylight.h"

#include <array>
#include <cmath>

#include "common/scene/mitsuba/spectra.h"

namespace treefarm::mitsuba {
namespace {

using Rgb64 = Imath::Color3<double>;

/// Days since noon of 1 January 2000, universal time, by the integer formula in Mitsuba 0.6's sunmodel.h.
double days_since_2000(const Observation& o, double universal_hours) {
    const int shift = (o.month - 14) / 12;
    const int day_number = 1461 * (o.year + 4800 + shift) / 4 + 367 * (o.month - 2 - 12 * shift) / 12 -
                           3 * ((o.year + 4900 + shift) / 100) / 4 + o.day - 32075;
    return day_number - 0.5 + universal_hours / 24.0 - 2451545.0;
}

/// Integral of the CIE 1931 ybar over the wavelength, nm: what a luminance is divided by to be an average per nm.
constexpr double kIntegralOfY = 106.857;
constexpr double kLumenPerWatt = 683.0;

/// Of the zenith: rows for turbidity^2, turbidity and 1, columns for the third to the zeroth power of the sun's angle.
double chromaticity(const std::array<std::array<double, 4>, 3>& m, double turbidity, double angle) {
    double value = 0.0;
    for (const auto& row : m)
        value = value * turbidity + ((row[0] * angle + row[1]) * angle + row[2]) * angle + row[3];
    return value;
}

/// From 380 to 750 nm at every 10: radiance of the sun outside the atmosphere in W / (m^2 sr nm), from the table
/// solAmplitudes of Mitsuba 0.6's sunmodel.h, and absorption of ozone and of water vapour, 1/cm, as there and in
/// github.com/ebruneton/clear-sky-models. (Mixed gases absorb beyond 750 nm only.)
struct SunSample {
    double radiance, ozone, vapour;
};
constexpr std::array<SunSample, 38> kSun = {
    {{16559.0, 0.0, 0.0},     {16233.7, 0.0, 0.0},      {21127.5, 0.0, 0.0},   {25888.2, 0.0, 0.0},
     {25829.1, 0.0, 0.0},     {24232.3, 0.0, 0.0},      {26760.5, 0.0, 0.0},   {29658.3, 0.003, 0.0},
     {30545.4, 0.006, 0.0},   {30057.5, 0.009, 0.0},    {30663.7, 0.014, 0.0}, {28830.4, 0.021, 0.0},
     {28712.1, 0.030, 0.0},   {27825.0, 0.040, 0.0},    {27100.6, 0.048, 0.0}, {27233.6, 0.063, 0.0},
     {26361.3, 0.075, 0.0},   {25503.8, 0.085, 0.0},    {25060.2, 0.103, 0.0}, {25311.6, 0.120, 0.0},
     {25355.9, 0.120, 0.0},   {25134.2, 0.115, 0.0},    {24631.5, 0.125, 0.0}, {24173.2, 0.120, 0.0},
     {23685.3, 0.105, 0.0},   {23212.1, 0.090, 0.0},    {22827.7, 0.079, 0.0}, {22339.8, 0.067, 0.0},
     {21970.2, 0.057, 0.0},   {21526.7, 0.048, 0.0},    {21097.9, 0.036, 0.0}, {20728.3, 0.028, 0.016},
     {20240.4, 0.023, 0.024}, {19870.8, 0.018, 0.0125}, {19427.2, 0.014, 1.0}, {19072.4, 0.011, 0.87},
     {18628.9, 0.010, 0.061}, {18259.2, 0.009, 0.001}}};

}  // namespace

SkyAngles sun_position(const Observation& o) {
    const double hours = o.hour - o.timezone + (o.minute + o.second / 60.0) / 60.0;
    const double days = days_since_2000(o, hours);

    const double omega = 2.1429 - 0.0010394594 * days;
    const double mean_longitude = 4.8950630 + 0.017202791698 * days;
    const double anomaly = 6.2400600 + 0.0172019699 * days;
    const double longitude = mean_longitude + 0.03341607 * std::sin(anomaly) + 0.00034894 * std::sin(2.0 * anomaly) -
                             0.0001134 - 0.0000203 * std::sin(omega);
    const double obliquity = 0.4090928 - 6.2140e-9 * days + 0.0000396 * std::cos(omega);

    const double right_ascension = std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
    const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));

    const double sidereal_hours = 6.6974243242 + 0.0657098283 * days + hours;
    const double hour_angle = (sidereal_hours * 15.0 + o.longitude) * M_PI / 180.0 - right_ascension;
    const double latitude = o.latitude * M_PI / 180.0;
    const double cosine =
        std::cos(latitude) * std::cos(hour_angle) * std::cos(declination) + std::sin(declination) * std::sin(latitude);

    SkyAngles sun;
    sun.zenith = std::acos(std::clamp(cosine, -1.0, 1.0));
    sun.azimuth = std::atan2(-std::sin(hour_angle),
                             std::tan(declination) * std::cos(latitude) - std::sin(latitude) * std::cos(hour_angle));
    // Seen from the surface, not from the centre of the earth: its radius over the distance of the sun.
    sun.zenith += 6371.01 / 149597890.0 * std::sin(sun.zenith);
    return sun;
}

PreethamSky::PreethamSky(double t, double sun_zenith)
    : luminance_{0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251,
                 0.1206 * t - 2.5771, -0.0670 * t + 0.3703, 1.0},
      x_{-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125,
         -0.0641 * t - 0.8989, -0.0033 * t + 0.0452, 1.0},
      y_{-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102,
         -0.0441 * t - 1.6537, -0.0109 * t + 0.0529, 1.0} {
    const double chi = (4.0 / 9.0 - t / 120.0) * (M_PI - 2.0 * sun_zenith);
    const double zenith_kcd = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
    const double zenith_x = chromaticity({{{0.00166, -0.00375, 0.00209, 0.0},
                                           {-0.02903, 0.06377, -0.03202, 0.00394},
                                           {0.11693, -0.21196, 0.06052, 0.25886}}},
                                         t, sun_zenith);
    const double zenith_y = chromaticity({{{0.00275, -0.00610, 0.00317, 0.0},
                                           {-0.04214, 0.08970, -0.04153, 0.00516},
                                           {0.15346, -0.26756, 0.06670, 0.26688}}},
                                         t, sun_zenith);
    const auto set = [&](Channel& channel, double zenith) {
        channel.scale = zenith / distribution(channel, 1.0, sun_zenith);
    };
    set(luminance_, zenith_kcd * 1000.0 / (kLumenPerWatt * kIntegralOfY));
    set(x_, zenith_x);
    set(y_, zenith_y);
}

double PreethamSky::distribution(const Channel& p, double cos_zenith, double from_sun) {
    const double cos_from_sun = std::cos(from_sun);
    return p.scale * (1.0 + p.a * std::exp(p.b / cos_zenith)) *
           (1.0 + p.c * std::exp(p.d * from_sun) + p.e * cos_from_sun * cos_from_sun);
}

Rgb64 PreethamSky::radiance(double zenith, double from_sun) const {
    const double cosine = std::max(std::cos(zenith), 1e-3);
    const double luminance = std::max(distribution(luminance_, cosine, from_sun), 0.0);
    const double x = distribution(x_, cosine, from_sun), y = distribution(y_, cosine, from_sun);
    const Rgb64 rgb = xyz_to_rgb(luminance / y * x, luminance, luminance / y * std::max(1.0 - x - y, 0.0));
    return {std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)};
}

Rgb64 preetham_sun(double turbidity, double sun_zenith) {
    const double degrees = sun_zenith * 180.0 / M_PI;
    const double mass = 1.0 / (std::cos(sun_zenith) + 0.15 * std::pow(93.885 - degrees, -1.253));
    const double beta = 0.04608 * turbidity - 0.04586;
    constexpr double kOzone = 0.35, kVapour = 2.0;  // cm
    SpectrumSamples spectrum;
    for (std::size_t i = 0; i < kSun.size(); ++i) {
        const double nanometres = 380.0 + 10.0 * static_cast<double>(i), micrometres = nanometres / 1000.0;
        const SunSample& sun = kSun[i];
        const double depth =
            mass * (0.008735 * std::pow(micrometres, -4.08) + beta * std::pow(micrometres, -1.3) + sun.ozone * kOzone) +
            0.2385 * sun.vapour * kVapour * mass / std::pow(1.0 + 20.07 * sun.vapour * kVapour * mass, 0.45);
        spectrum.emplace_back(nanometres, sun.radiance * std::exp(-depth));
    }
    const Rgb64 rgb = spectrum_to_rgb(spectrum, false);
    return {std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)};
}

}  // namespace treefarm::mitsuba
