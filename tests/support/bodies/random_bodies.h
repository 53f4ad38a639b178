#pragma once

#include <random>

#include "bullet_ambient/spatial/spatial_vectors.h"
#include "tests/support/bodies/geodesic.h"

namespace ambient::test {

/// Source of reproducible random values.
class Arbitrary {
 public:
  explicit Arbitrary(unsigned seed) : engine_(seed) {}

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  Vector3 vector(double size = 1) {
    std::normal_distribution<double> normal;
    // Braces evaluate from left to right in every compiler.
    return size * Vector3{normal(engine_), normal(engine_), normal(engine_)};
  }
  Matrix3 rotation() {
    std::normal_distribution<double> normal;
    return Quaternion{normal(engine_), normal(engine_), normal(engine_), normal(engine_)}
        .normalized()
        .toRotationMatrix();
  }
  Twist twist(double angular = 1, double linear = 1) { return {vector(angular), vector(linear)}; }
  Matrix6 positiveDefinite() {
    Matrix6 factor;
    for (Eigen::Index i = 0; i < factor.size(); ++i) factor.data()[i] = between(-1, 1);
    return factor * factor.transpose() + 0.1 * Matrix6::Identity();
  }
  /// A closed bumpy body: a geodesic sphere, stretched, its vertices moved in and out.
  FaceTable body(int level = 1) {
    Triangulation mesh = geodesicSphere(level);
    const Vector3 semi_axes{between(0.2, 2), between(0.2, 2), between(0.2, 2)};
    const Matrix3 turned = rotation();
    const Vector3 offset = vector(0.3);
    for (Vector3& vertex : mesh.vertices)
      vertex = turned * (between(0.7, 1.3) * vertex).cwiseProduct(semi_axes) + offset;
    return faceTableOf(mesh);
  }

 private:
  std::mt19937 engine_;
};

}  // namespace ambient::test
