// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/colour/daylight.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "coordinator/input/colour/spectra.h"

namespace treefarm {
namespace {

using Rgb64 = Imath::Color3<double>;

/// Days since noon of 1 January 2000, universal time, by the integer formula in Mitsuba 0.6's sunmodel.h.
double days_since_2000(const Observation& o, double universal_hours) {
    const int shift = (o.month - 14) / 12;
    const int day_number = 1461 * (o.year + 4800 + shift) / 4 + 367 * (o.month - 2 - 12 * shift) / 12 -
                           3 * ((o.year + 4900 + shift) / 100) / 4 + o.day - 32075;
    return day_number - 0.5 + universal_hours / 24.0 - 2451545.0;
}

/// Tables of Mitsuba 0.6's sunmodel.h over the wavelength (nm), linear between entries and 0 outside. Mixed gases are
/// left out: they absorb beyond 750 nm only, where the sun's table has ended.
using Table = std::span<const std::pair<double, double>>;

double value_at(Table table, double nanometres) {
    const auto next = std::lower_bound(table.begin(), table.end(), nanometres,
                                       [](const auto& entry, double w) { return entry.first < w; });
    if (next == table.end() || nanometres < table.front().first) return 0.0;
    if (next->first == nanometres) return next->second;
    const auto& before = *std::prev(next);
    return before.second + (next->second - before.second) * (nanometres - before.first) / (next->first - before.first);
}

/// Radiance of the sun outside the atmosphere, W / (m^2 sr nm): solAmplitudes.
constexpr std::pair<double, double> kSun[] = {
    {380, 16559.0}, {390, 16233.7}, {400, 21127.5}, {410, 25888.2}, {420, 25829.1}, {430, 24232.3}, {440, 26760.5},
    {450, 29658.3}, {460, 30545.4}, {470, 30057.5}, {480, 30663.7}, {490, 28830.4}, {500, 28712.1}, {510, 27825.0},
    {520, 27100.6}, {530, 27233.6}, {540, 26361.3}, {550, 25503.8}, {560, 25060.2}, {570, 25311.6}, {580, 25355.9},
    {590, 25134.2}, {600, 24631.5}, {610, 24173.2}, {620, 23685.3}, {630, 23212.1}, {640, 22827.7}, {650, 22339.8},
    {660, 21970.2}, {670, 21526.7}, {680, 21097.9}, {690, 20728.3}, {700, 20240.4}, {710, 19870.8}, {720, 19427.2},
    {730, 19072.4}, {740, 18628.9}, {750, 18259.2}};

/// Absorption by ozone, 1/cm: k_oAmplitudes, from the beginning of the visible spectrum.
constexpr std::pair<double, double> kOzone[] = {
    {355, 0.0},   {445, 0.003}, {450, 0.003}, {455, 0.004}, {460, 0.006}, {465, 0.008}, {470, 0.009}, {475, 0.012},
    {480, 0.014}, {485, 0.017}, {490, 0.021}, {495, 0.025}, {500, 0.03},  {505, 0.035}, {510, 0.04},  {515, 0.045},
    {520, 0.048}, {525, 0.057}, {530, 0.063}, {535, 0.07},  {540, 0.075}, {545, 0.08},  {550, 0.085}, {555, 0.095},
    {560, 0.103}, {565, 0.11},  {570, 0.12},  {575, 0.122}, {580, 0.12},  {585, 0.118}, {590, 0.115}, {595, 0.12},
    {600, 0.125}, {605, 0.13},  {610, 0.12},  {620, 0.105}, {630, 0.09},  {640, 0.079}, {650, 0.067}, {660, 0.057},
    {670, 0.048}, {680, 0.036}, {690, 0.028}, {700, 0.023}, {710, 0.018}, {720, 0.014}, {730, 0.011}, {740, 0.01},
    {750, 0.009}, {760, 0.007}};

/// Absorption by water vapour, 1/cm: k_waAmplitudes.
constexpr std::pair<double, double> kVapour[] = {{689, 0.0},  {690, 0.016}, {700, 0.024}, {710, 0.0125}, {720, 1.0},
                                                 {730, 0.87}, {740, 0.061}, {750, 0.001}, {760, 1e-05}};

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
    // Parallax, since the view is from the surface: the earth's radius over the distance of the sun.
    sun.zenith += 6371.01 / 149597890.0 * std::sin(sun.zenith);
    return sun;
}

Rgb64 preetham_sun(double turbidity, double sun_zenith) {
    const double degrees = sun_zenith * 180.0 / M_PI;
    const double mass = 1.0 / (std::cos(sun_zenith) + 0.15 * std::pow(93.885 - degrees, -1.253));
    const double beta = 0.04608365822050 * turbidity - 0.04586025928522;
    constexpr double kOzoneDepth = 0.35, kVapourDepth = 2.0;  // cm
    SpectrumSamples spectrum;
    for (int nanometres = 375; nanometres <= 755; nanometres += 5) {
        const double micrometres = nanometres / 1000.0;
        const double vapour = value_at(kVapour, nanometres) * kVapourDepth * mass;
        const double depth = mass * (0.008735 * std::pow(micrometres, -4.08) + beta * std::pow(micrometres, -1.3) +
                                     value_at(kOzone, nanometres) * kOzoneDepth) +
                             0.2385 * vapour / std::pow(1.0 + 20.07 * vapour, 0.45);
        spectrum.emplace_back(nanometres, value_at(kSun, nanometres) * std::exp(-depth));
    }
    const Rgb64 rgb = spectrum_to_rgb(spectrum, false);
    return {std::max(rgb.x, 0.0), std::max(rgb.y, 0.0), std::max(rgb.z, 0.0)};
}

}  // namespace treefarm
