// SPDX-License-Identifier: Apache-2.0
#include "coordinator/input/mitsuba/transforms.h"

#include <cmath>

#include "coordinator/input/mitsuba/values.h"

namespace treefarm::mitsuba {
namespace {

using Vec3d = Imath::V3d;

/// Reads x, y and z, or all of them from `value`.
Vec3d read_xyz(const XmlElement& step, double otherwise) {
    if (const std::string* value = step.find("value")) {
        if (step.find("x") || step.find("y") || step.find("z"))
            throw InputError(step.where, "<" + step.tag + "> has both value and x, y or z", "give one or the other");
        const std::vector<double> numbers = numbers_of(*value, step.where);
        if (numbers.size() == 1) return Vec3d(numbers[0]);
        if (numbers.size() == 3) return {numbers[0], numbers[1], numbers[2]};
        throw InputError(step.where, "<" + step.tag + "> has " + std::to_string(numbers.size()) + " values, not 1 or 3",
                         "write for instance value=\"1, 2, 3\"");
    }
    Vec3d v(otherwise);
    const char* names[3] = {"x", "y", "z"};
    for (int i = 0; i < 3; ++i)
        if (const std::string* text = step.find(names[i])) v[i] = number_of(*text, step.where);
    return v;
}

Vec3d read_triple(const XmlElement& step, const char* name) {
    const std::vector<double> numbers = numbers_of(step.require(name), step.where);
    if (numbers.size() != 3)
        throw InputError(
            step.where,
            "<" + step.tag + "> has " + std::to_string(numbers.size()) + " numbers in \"" + name + "\", not 3",
            "write for instance \"1, 2, 3\"");
    return {numbers[0], numbers[1], numbers[2]};
}

Matrix from_axes(const Vec3d& x, const Vec3d& y, const Vec3d& z, const Vec3d& origin) {
    return Matrix(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, origin.x, origin.y, origin.z, 1);
}

Matrix translation(const Vec3d& v) {
    return from_axes({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, v);
}

Matrix scaling(const Vec3d& v) {
    return from_axes({v.x, 0, 0}, {0, v.y, 0}, {0, 0, v.z}, {0, 0, 0});
}

/// Rodrigues' rotation formula: images of the three axes. Exact for whole quarter turns.
Matrix rotation(const XmlElement& step) {
    Vec3d axis = read_xyz(step, 0.0);
    if (!(axis.length() > 0.0)) throw InputError(step.where, "<rotate> has no axis", "give one, for instance y=\"1\"");
    axis.normalize();
    const double degrees = number_of(step.require("angle"), step.where);
    const double turn = std::remainder(degrees, 360.0);
    double sine = std::sin(turn * M_PI / 180.0), cosine = std::cos(turn * M_PI / 180.0);
    if (std::abs(turn) == 180.0 || turn == 0.0) sine = 0.0;
    if (std::abs(turn) == 90.0) cosine = 0.0;
    const auto rotated = [&](const Vec3d& v) {
        return v * cosine + axis.cross(v) * sine + axis * (axis.dot(v) * (1.0 - cosine));
    };
    return from_axes(rotated({1, 0, 0}), rotated({0, 1, 0}), rotated({0, 0, 1}), {0, 0, 0});
}

/// Reads 16 numbers row by row, for column vectors; or the 9 of the linear part.
Matrix matrix_step(const XmlElement& step) {
    const std::vector<double> m = numbers_of(step.require("value"), step.where);
    if (m.size() != 16 && m.size() != 9)
        throw InputError(step.where, "<matrix> has " + std::to_string(m.size()) + " numbers, not 16 or 9",
                         "give all of them");
    const std::size_t stride = m.size() == 16 ? 4 : 3;
    Matrix matrix;
    for (std::size_t row = 0; row < stride; ++row)
        for (std::size_t column = 0; column < stride; ++column)
            matrix[static_cast<int>(column)][static_cast<int>(row)] = m[row * stride + column];
    if (stride == 4 && (m[12] != 0.0 || m[13] != 0.0 || m[14] != 0.0 || m[15] != 1.0))
        throw InputError(step.where, "<matrix> is not affine", "its last row must be 0 0 0 1");
    return matrix;
}

/// Camera space: z towards the target, y up, x to the left.
Matrix look_at(const XmlElement& step) {
    const Vec3d origin = read_triple(step, "origin"), target = read_triple(step, "target");
    const Vec3d forward = (target - origin).normalized();
    if (!(forward.length() > 0.0))
        throw InputError(step.where, "<lookat> has its target at its origin", "move one of them");
    Vec3d up(0.0);
    if (step.find("up")) up = read_triple(step, "up");
    if (!(up.length() > 0.0)) up = std::abs(forward.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0);
    const Vec3d left = up.normalized().cross(forward);
    if (!(left.length() > 1e-9))
        throw InputError(step.where, "<lookat> looks along its up direction", "give another up");
    return from_axes(left.normalized(), forward.cross(left.normalized()), forward, origin);
}

Matrix read_step(const XmlElement& step) {
    if (!step.children.empty())
        throw InputError(step.children[0].where, "<" + step.tag + "> has elements inside", "remove them");
    if (step.tag == "translate") {
        step.allow_attributes({"x", "y", "z", "value"});
        return translation(read_xyz(step, 0.0));
    }
    if (step.tag == "scale") {
        step.allow_attributes({"x", "y", "z", "value"});
        if (step.attributes.empty()) throw InputError(step.where, "<scale> has no factor", "give value, or x, y and z");
        return scaling(read_xyz(step, 1.0));
    }
    if (step.tag == "rotate") {
        step.allow_attributes({"x", "y", "z", "value", "angle"});
        return rotation(step);
    }
    if (step.tag == "matrix") {
        step.allow_attributes({"value"});
        return matrix_step(step);
    }
    if (step.tag == "lookat" || step.tag == "lookAt") {
        step.allow_attributes({"origin", "target", "up"});
        return look_at(step);
    }
    throw InputError(step.where, "<" + step.tag + "> is no transformation",
                     "use translate, rotate, scale, matrix or lookat");
}

/// Whether the three axes are in a plane, whatever their lengths.
bool is_singular(const Matrix& m) {
    const Vec3d x(m[0][0], m[0][1], m[0][2]), y(m[1][0], m[1][1], m[1][2]), z(m[2][0], m[2][1], m[2][2]);
    const double volume = std::abs(x.normalized().dot(y.normalized().cross(z.normalized())));
    return !(volume > 1e-9);
}

}  // namespace

Matrix read_transform(const XmlElement& element, const std::string& owner) {
    Matrix matrix;
    for (const XmlElement& step : element.children)
        matrix = matrix * read_step(step);
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            if (!(std::abs(matrix[row][column]) <= 1e30))
                throw InputError(element.where, "the transformation of " + owner + " is too large or not a number",
                                 "check its numbers");
    if (is_singular(matrix))
        throw InputError(element.where, "the transformation of " + owner + " is singular: it flattens space",
                         "give no scale of 0");
    return matrix;
}

Vec3 transform_point(const Matrix& m, const Vec3& p) {
    Vec3 result;
    for (int i = 0; i < 3; ++i)
        result[i] = static_cast<float>(p.x * m[0][i] + p.y * m[1][i] + p.z * m[2][i] + m[3][i]);
    return result;
}

Vec3 transform_vector(const Matrix& m, const Vec3& v) {
    Vec3 result;
    for (int i = 0; i < 3; ++i)
        result[i] = static_cast<float>(v.x * m[0][i] + v.y * m[1][i] + v.z * m[2][i]);
    return result;
}

Vec3 NormalTransform::operator()(const Vec3& n) const {
    Imath::V3d result;
    for (int i = 0; i < 3; ++i)
        result[i] = n.x * inverse_[i][0] + n.y * inverse_[i][1] + n.z * inverse_[i][2];
    result.normalize();
    return Vec3(static_cast<float>(result.x), static_cast<float>(result.y), static_cast<float>(result.z));
}

bool is_mirroring(const Matrix& m) {
    return Vec3d(m[0][0], m[0][1], m[0][2])
               .cross(Vec3d(m[1][0], m[1][1], m[1][2]))
               .dot(Vec3d(m[2][0], m[2][1], m[2][2])) < 0.0;
}

double uniform_scale(const Matrix& m, double tolerance) {
    const Vec3d axes[3] = {{m[0][0], m[0][1], m[0][2]}, {m[1][0], m[1][1], m[1][2]}, {m[2][0], m[2][1], m[2][2]}};
    const double squared = axes[0].dot(axes[0]);
    for (int i = 0; i < 3; ++i)
        for (int j = i; j < 3; ++j) {
            const double expected = i == j ? squared : 0.0;
            if (std::abs(axes[i].dot(axes[j]) - expected) > tolerance * squared) return 0.0;
        }
    return std::sqrt(squared);
}

}  // namespace treefarm::mitsuba
