// SPDX-License-Identifier: Apache-2.0
#include "worker/camera/camera_importance.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/math/elementary.h"
#include "common/math/warp.h"

namespace treefarm {

CameraImportance::CameraImportance(const Camera& camera, const Film& film)
    : origin_(camera.origin),
      corner_(camera.corner),
      across_(camera.across),
      down_(camera.down),
      normal_(across_.cross(down_)),
      parallel_(camera.parallel),
      lens_u_(camera.lens_u),
      lens_v_(camera.lens_v),
      width_(film.whole_width()),
      height_(film.whole_height()),
      has_lens_(camera.has_lens()),
      is_parallel_(camera.is_orthographic()),
      panoramic_(camera.panoramic) {}

void CameraImportance::set_position(FilmConnection& connection, const Vec3d& from_corner) const {
    const double per_area2 = 1.0 / normal_.dot(normal_);
    connection.x = from_corner.cross(down_).dot(normal_) * per_area2 * width_;
    connection.y = across_.cross(from_corner).dot(normal_) * per_area2 * height_;
}

FilmConnection CameraImportance::through_lens(const Vec3& p, const Draw& lens) const {
    Vec3d shift(0.0);
    if (has_lens_) {
        const Vec2 at = square_to_disk({to_unit(lens[0]), to_unit(lens[1])});
        shift = Vec3d(lens_u_ * at.x + lens_v_ * at.y);
    }
    FilmConnection connection;
    const Vec3d to_p = Vec3d(p) - origin_ - shift;
    const double ahead = to_p.dot(normal_);
    // the focal plane is at the fraction t of the distance to p
    const double t = (corner_ - shift).dot(normal_) / ahead;
    const double distance2 = to_p.dot(to_p);
    if (!(t > 0.0 && std::isfinite(t) && distance2 > 0.0)) return connection;
    set_position(connection, shift + to_p * t - corner_);
    const double distance = std::sqrt(distance2), cubed = distance2 * distance * t * t;
    connection.direction_pdf = cubed / std::abs(ahead);
    connection.g = connection.direction_pdf / distance2;
    connection.target = Vec3(origin_) + Vec3(shift);
    connection.direction = Vec3(to_p * (-1.0 / distance));
    connection.seen = std::isfinite(connection.g);
    return connection;
}

FilmConnection CameraImportance::parallel(const Vec3& p) const {
    FilmConnection connection;
    const Vec3d from_corner = Vec3d(p) - origin_ - corner_;
    const double along = parallel_.dot(normal_), distance = from_corner.dot(normal_) / along;
    if (!(distance > 0.0 && std::isfinite(distance))) return connection;
    set_position(connection, from_corner - parallel_ * distance);
    connection.g = 1.0 / std::abs(along);
    connection.target = Vec3(Vec3d(p) - parallel_ * distance);
    connection.direction = Vec3(-parallel_);
    connection.seen = true;
    return connection;
}

FilmConnection CameraImportance::panorama(const Vec3& p) const {
    FilmConnection connection;
    const Vec3d to_p = Vec3d(p) - origin_;
    const double distance2 = to_p.dot(to_p);
    const double left = to_p.dot(across_), up = to_p.dot(down_), forwards = -to_p.dot(corner_);
    const double level2 = left * left + forwards * forwards;
    if (!(level2 > 0.0)) return connection;
    const double distance = std::sqrt(distance2), level = std::sqrt(level2);
    // Angles depend on ratios alone; lengths over the distance fit a float.
    const auto unit = [&](double length) { return static_cast<float>(length / distance); };
    connection.x = double(azimuth_turn(unit(forwards), unit(left))) * width_;
    connection.y = 2.0 * double(azimuth_turn(unit(up), unit(level))) * height_;
    connection.direction_pdf = distance / (level * 2.0 * double(kPi) * double(kPi));
    connection.g = connection.direction_pdf / distance2;
    connection.target = Vec3(origin_);
    connection.direction = Vec3(to_p * (-1.0 / distance));
    connection.seen = std::isfinite(connection.g);
    return connection;
}

PixelPicker::PixelPicker(const Film& film, bool panoramic)
    : filter_(film),
      x0_(film.crop.x),
      y0_(film.crop.y),
      x1_(film.crop.x + film.width),
      y1_(film.crop.y + film.height),
      whole_width_(film.whole_width()),
      whole_height_(film.whole_height()),
      per_window_(whole_width_ * whole_height_ / static_cast<double>(film.pixel_count())),
      panoramic_(panoramic) {}

bool PixelPicker::reaches(double x, double y) const {
    if (panoramic_) return true;
    const double reach = double(filter_.radius()) - 0.5;
    return x >= x0_ - reach && x <= x1_ + reach && y >= y0_ - reach && y <= y1_ + reach;
}

PixelPicker::Axis PixelPicker::pick_along(double x, int begin, int end, std::uint32_t random) const {
    const auto radius = double(filter_.radius());
    // At most as many columns as the filter is wide; the comparison first keeps huge positions out of int.
    const double lowest = std::max(std::floor(x - 0.5 - radius), double(begin)),
                 highest = std::min(std::ceil(x - 0.5 + radius), double(end - 1));
    Axis axis;
    if (!(lowest <= highest)) return axis;
    const int first = static_cast<int>(lowest), last = static_cast<int>(highest);
    const auto value = [&](int i) { return double(filter_.value(static_cast<float>(x - (i + 0.5)))); };
    for (int i = first; i <= last; ++i)
        axis.sum += value(i);
    double rest = double(to_unit(random)) * axis.sum;
    for (int i = first; i <= last; ++i) {
        const double here = value(i);
        if (!(here > 0.0)) continue;
        axis.pixel = i;
        if (rest < here) break;
        rest -= here;
    }
    return axis;
}

PixelPick PixelPicker::pick_point(double x, double y, const Draw& random) const {
    const Axis column = pick_along(x, x0_, x1_, random[0]), row = pick_along(y, y0_, y1_, random[1]);
    PixelPick pick;
    pick.weight = column.sum * row.sum * per_window_;
    pick.found = pick.weight > 0.0;
    if (pick.found)
        pick.pixel = static_cast<std::uint32_t>(row.pixel - y0_) * static_cast<std::uint32_t>(x1_ - x0_) +
                     static_cast<std::uint32_t>(column.pixel - x0_);
    return pick;
}

PixelPick PixelPicker::pick_of_panorama(double x, double y, const Draw& random) const {
    // Beyond a pole the panorama continues half a turn away; left and right edges are neighbours (CameraRays).
    std::array<PixelPick, 9> picks;
    double sum = 0;
    std::size_t count = 0;
    for (int pole = 0; pole < 3; ++pole)
        for (int turn = -1; turn <= 1; ++turn) {
            const double half = pole == 0 ? 0.0 : (x < 0.5 * whole_width_ ? 0.5 : -0.5) * whole_width_;
            const double down = pole == 0 ? y : (pole == 1 ? -y : 2 * whole_height_ - y);
            const PixelPick pick = pick_point(x + half + turn * whole_width_, down, random);
            if (!pick.found) continue;
            picks[count++] = pick;
            sum += pick.weight;
        }
    if (count == 0) return {};
    double rest = double(to_unit(random[2])) * sum;
    std::size_t chosen = 0;
    while (chosen + 1 < count && !(rest < picks[chosen].weight))
        rest -= picks[chosen++].weight;
    picks[chosen].weight = sum;
    return picks[chosen];
}

PixelPick PixelPicker::pick(double x, double y, const Draw& random) const {
    return panoramic_ ? pick_of_panorama(x, y, random) : pick_point(x, y, random);
}

}  // namespace treefarm
