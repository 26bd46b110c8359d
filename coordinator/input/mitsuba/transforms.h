// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "common/math/vec.h"
#include "coordinator/input/mitsuba/xml_document.h"

namespace treefarm::mitsuba {

/// Affine map in double precision, for row vectors as in Imath: a point p becomes p * matrix, so later steps are
/// further right.
using Matrix = Imath::M44d;

/// Matrix of a <transform>: translate, rotate, scale, matrix and lookat (lookAt), applied in document order. Throws
/// InputError if it is not affine, finite and invertible; `owner`: name of the object for that message.
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

/// Whether the map turns right-handed into left-handed.
bool is_mirroring(const Matrix& matrix);

/// Factor on lengths if it is equal in all directions (tolerance relative to its square); otherwise 0.
double uniform_scale(const Matrix& matrix, double tolerance = 1e-4);

}  // namespace treefarm::mitsuba
