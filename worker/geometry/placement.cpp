// SPDX-License-Identifier: Apache-2.0
#include "worker/geometry/placement.h"

#include "common/base/error.h"
#include "worker/geometry/primitive_points.h"

namespace treefarm {
namespace {

/// Cofactors of a 3 x 3 matrix, and for each the sum of absolute terms, to which rounding error is proportional.
struct Cofactors {
    double value[3][3], size[3][3];

    explicit Cofactors(const double (&m)[3][3]) {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
                const double a = m[i1][j1] * m[i2][j2], b = m[i1][j2] * m[i2][j1];
                value[i][j] = a - b;
                size[i][j] = std::abs(a) + std::abs(b);
            }
    }
};

}  // namespace

Placement::Placement(const Instance& instance, std::uint32_t shape)
    : to_world_(instance.to_world), group_(static_cast<std::uint32_t>(instance.group)), instance_(shape + 1) {
    double m[3][3];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            m[i][j] = double(to_world_[i][j]);
    const Cofactors cofactors(m);
    double determinant = 0, size = 0;
    for (int j = 0; j < 3; ++j) {
        determinant += m[0][j] * cofactors.value[0][j];
        size += std::abs(m[0][j]) * cofactors.size[0][j];
    }
    if (!(std::abs(determinant) > 1e-12 * size) || !std::isfinite(size))
        throw RunError("the transform of instance " + std::to_string(shape) + " cannot be inverted");
    constexpr double kEpsilon = 0x1p-23;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double inverse = cofactors.value[j][i] / determinant;
            exact_inverse_[i][j] = inverse;
            inverse_[i][j] = static_cast<float>(inverse);
            // Rounding error of cofactor, determinant, and the products and sums afterwards, each bounded generously.
            slack_[i][j] =
                static_cast<float>(kEpsilon * (8.0 * cofactors.size[j][i] / std::abs(determinant) +
                                               std::abs(inverse) * (8.0 * size / std::abs(determinant) + 16.0)));
        }
}

Hit Placement::to_world(const Hit& local) const {
    Hit hit = local;
    hit.instance = instance_;
    const Vec3 t(to_world_[3][0], to_world_[3][1], to_world_[3][2]);
    hit.p = vector_to_world(local.p) + t;
    const auto normal = [&](const Vec3& n) {
        return Vec3(n.x * inverse_[0][0] + n.y * inverse_[0][1] + n.z * inverse_[0][2],
                    n.x * inverse_[1][0] + n.y * inverse_[1][1] + n.z * inverse_[1][2],
                    n.x * inverse_[2][0] + n.y * inverse_[2][1] + n.z * inverse_[2][2]);
    };
    const Vec3 ng = normal(local.ng);
    const float stretch = ng.length();  // displacement of the plane in the group for a unit step along ng in the world
    hit.ng = ng * (1.0f / stretch);
    hit.ns = normalize(normal(local.ns));
    float across = local.error;
    for (int i = 0; i < 3; ++i) {
        float wobble = 0.0f;
        for (int j = 0; j < 3; ++j)
            wobble += slack_[j][i] * (std::abs(hit.p[j]) + std::abs(t[j]));
        across += std::abs(local.ng[i]) * wobble;
    }
    hit.error = across / stretch + offset_bound(max_abs(hit.p) + max_abs(t));
    return hit;
}

Vec3 Placement::normal_to_local(const Vec3& n) const {
    return normalize(Vec3(n.x * to_world_[0][0] + n.y * to_world_[0][1] + n.z * to_world_[0][2],
                          n.x * to_world_[1][0] + n.y * to_world_[1][1] + n.z * to_world_[1][2],
                          n.x * to_world_[2][0] + n.y * to_world_[2][1] + n.z * to_world_[2][2]));
}

Vec3 Placement::vector_to_world(const Vec3& v) const {
    return {v.x * to_world_[0][0] + v.y * to_world_[1][0] + v.z * to_world_[2][0],
            v.x * to_world_[0][1] + v.y * to_world_[1][1] + v.z * to_world_[2][1],
            v.x * to_world_[0][2] + v.y * to_world_[1][2] + v.z * to_world_[2][2]};
}

Imath::V3d Placement::point_to_world(const Imath::V3d& local) const {
    Imath::V3d p;
    for (int j = 0; j < 3; ++j) {
        p[j] = double(to_world_[3][j]);
        for (int i = 0; i < 3; ++i)
            p[j] += local[i] * double(to_world_[i][j]);
    }
    return p;
}

Imath::V3d Placement::point_to_local(const Imath::V3d& world) const {
    return (world - point_to_world(Imath::V3d(0.0))) * exact_inverse_;
}

Imath::V3d Placement::covector_to_local(const Imath::V3d& normal) const {
    Imath::V3d w(0.0);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            w[i] += double(to_world_[i][j]) * normal[j];
    return w;
}

// The Frobenius norm of a matrix is an upper bound of its stretch of any vector.

double Placement::least_stretch() const {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            sum += exact_inverse_[i][j] * exact_inverse_[i][j];
    return 1.0 / std::sqrt(sum);
}

double Placement::most_stretch() const {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            sum += double(to_world_[i][j]) * double(to_world_[i][j]);
    return std::sqrt(sum);
}

}  // namespace treefarm
