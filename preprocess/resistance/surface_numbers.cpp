#include "preprocess/resistance/surface_numbers.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/geometry.h"

namespace ambient {
namespace {

/// Mean of z z^T over a surface, z from a centre [m^2].
Matrix3 meanSquares(const TriangleMesh& mesh, double area, const Vector3& centre) {
  Matrix3 sum = Matrix3::Zero();
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const Vector3 c = Vector3(mesh.barycentre(t)) - centre;
    Matrix3 mean = c * c.transpose();
    for (int k = 0; k < 3; ++k) {
      const Vector3 r = Vector3(mesh.corner(t, k) - mesh.barycentre(t));
      mean += r * r.transpose() / 12;
    }
    sum += areaOf(mesh, t) * mean;
  }
  return sum / area;
}

}  // namespace

SurfaceNumbers computeSurfaceNumbers(const TriangleMesh& mesh, bool sheet,
                                     const BodyCentres& centres, const Matrix3& axes) {
  const double area = areaOf(mesh), sides = sheet ? 2 : 1;
  AMBIENT_ASSERT(area > 0);
  SurfaceNumbers numbers;
  numbers.diameter = std::sqrt(sides * area / kPi);
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t)
    numbers.frontal += sides / 4 * (axes.transpose() * Vector3(mesh.twiceArea(t))).cwiseAbs();
  numbers.moments = (axes.transpose() * meanSquares(mesh, area, centres.volume) * axes).diagonal();
  const Matrix3 squares = meanSquares(mesh, area, centres.reaction);
  numbers.gyration = squares.trace() * Matrix3::Identity() - squares;
  return numbers;
}

double sharpShare(const FormShape& shape) {
  constexpr double kAllEdges = 0.9;
  const double eps = std::min(1.0, shape.edges / kAllEdges);
  return eps + shape.wing * (1 - eps);
}

}  // namespace ambient
