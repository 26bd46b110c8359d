// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/field_of_view.h"

#include <cmath>

#include "common/base/text/parse_text.h"

namespace treefarm::mitsuba {
namespace {

/// Half the film's width at distance 1, from the field of view along `axis`.
double half_width(double fov, const std::string& axis, double aspect, const Location& where,
                  const Location& where_axis) {
    if (!(fov > 0.0 && fov < 180.0))
        throw InputError(where, "a field of view of " + number_text(fov) + " degrees",
                         "give more than 0 and less than 180");
    const double half = std::tan(fov * M_PI / 180.0 / 2.0);
    if (axis == "x") return half;
    if (axis == "y") return half * aspect;
    if (axis == "diagonal") return half / std::sqrt(1.0 + 1.0 / (aspect * aspect));
    if (axis == "smaller") return aspect > 1.0 ? half * aspect : half;
    if (axis == "larger") return aspect > 1.0 ? half : half * aspect;
    throw InputError(where_axis, "unknown axis " + in_quotes(axis) + " of the field of view",
                     "use x, y, diagonal, smaller or larger");
}

/// Field of view over the diagonal of a film of 36 x 24 mm, in degrees.
double diagonal_fov(const std::string& focal_length, const Location& where) {
    std::string_view text = trim(focal_length);
    if (text.ends_with("mm")) text.remove_suffix(2);
    const auto length = parse_number(text);
    if (!length || *length <= 0.0)
        throw InputError(where, in_quotes(focal_length) + " is not a focal length", "write for instance 50mm");
    return 2.0 * std::atan(std::sqrt(36.0 * 36.0 + 24.0 * 24.0) / (2.0 * *length)) * 180.0 / M_PI;
}

}  // namespace

double read_half_width(Properties& properties, double aspect) {
    if (properties.has("fov") && properties.has("focal_length"))
        throw InputError(properties.where("focal_length"), "both a field of view and a focal length are given",
                         "keep one");
    if (properties.has("fov")) {
        const std::string axis = lower_case(properties.text("fov_axis", "x"));
        return half_width(properties.number("fov", 0.0), axis, aspect, properties.where("fov"),
                          properties.where("fov_axis"));
    }
    properties.ignore({"fov_axis"});
    const Location& where = properties.where("focal_length");
    return half_width(diagonal_fov(properties.text("focal_length", "50mm"), where), "diagonal", aspect, where, where);
}

}  // namespace treefarm::mitsuba
