#include "preprocess/mesh/winding_number.h"

#include <cmath>

#include "bullet_ambient/spatial/elementary.h"

namespace ambient {

double solidAngle(const TriangleMesh& mesh, Eigen::Index triangle, const Eigen::Vector3d& point) {
  const Eigen::Vector3d a = mesh.corner(triangle, 0) - point;
  const Eigen::Vector3d b = mesh.corner(triangle, 1) - point;
  const Eigen::Vector3d c = mesh.corner(triangle, 2) - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double numerator = a.dot(b.cross(c));
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2 * portable::atan2(numerator, denominator);
}

}  // namespace ambient
