#include "preprocess/mesh/defects/winding_number.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/pi.h"

namespace ambient {

double solidAngle(const TriangleMesh& mesh, Eigen::Index triangle, const Eigen::Vector3d& point) {
  const Eigen::Vector3d a = mesh.corner(triangle, 0) - point;
  const Eigen::Vector3d b = mesh.corner(triangle, 1) - point;
  const Eigen::Vector3d c = mesh.corner(triangle, 2) - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double numerator = a.dot(b.cross(c));
  const double denominator = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  constexpr double kSmall = 0.01;  // of the tangent; what the series leaves out is below rounding
  if (!(std::abs(numerator) < kSmall * denominator))
    return 2 * portable::atan2(numerator, denominator);
  const double tangent = numerator / denominator, square = tangent * tangent;
  return 2 * tangent * (1 - square * (1.0 / 3 - square * (1.0 / 5 - square / 7)));
}

double enclosedVolume(const TriangleMesh& mesh) {
  constexpr double kAngles = 2e8;
  const auto triangles = static_cast<double>(mesh.triangleCount());
  const int count = static_cast<int>(std::clamp(portable::cbrt(kAngles / triangles), 8.0, 24.0));
  const Eigen::Vector3d low = mesh.vertices.rowwise().minCoeff(), step = mesh.extents() / count;
  int inside = 0;
  for (int i = 0; i < count * count * count; ++i) {
    const int x = i % count, y = i / count % count, z = i / (count * count);
    const Eigen::Array3d place(x, y, z);
    const Eigen::Vector3d point = low.array() + (place + 0.5) * step.array();
    double angle = 0;
    for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) angle += solidAngle(mesh, t, point);
    inside += std::abs(angle) > 2 * kPi ? 1 : 0;
  }
  return inside * step.prod();
}

}  // namespace ambient
