// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"
#include "coordinator/input/mitsuba/xml_document.h"

namespace treefarm::mitsuba {

/// An affine map in double precision. Row vectors, as Imath has them: a point p goes to p * matrix, so what happens
/// later stands further right.
using Matrix = Imath::M44d;

/// The matrix of a <transform>: translate, rotate, scale, matrix and lookat (lookAt), the first applied first. What is
/// not affine, not finite or not invertible throws InputError; `owner` names the object for that message.
Matrix read_transform(const XmlElement& element, const std::string& owner);

Vec3 transform_point(const Matrix& matrix, const Vec3& point);
Vec3 transform_vector(const Matrix& matrix, const Vec3& vector);

/// Maps normals by the inverse transpose; results are unit vectors.
class NormalTransform {
  public:
    explicit NormalTransform(const Matrix& matrix) : inverse_(matrix.inverse()) {}
    Vec3 operator()(const Vec3& normal) const;

  private:
    Matrix inverse_;
};

/// The map turns right-handed into left-handed.
bool is_mirroring(const Matrix& matrix);

/// The factor by which lengths grow, if it is the same in all directions (relative to its square); otherwise 0.
double uniform_scale(const Matrix& matrix, double tolerance = 1e-4);

}  // namespace treefarm::mitsuba
