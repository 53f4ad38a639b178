#include "preprocess/mesh/union/solid_contact.h"

#include <algorithm>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/defects/winding_number.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

struct Box {
  Vector3d low, high;

  bool meets(const Box& other, double gap) const {
    return ((low - other.high).array() <= gap).all() && ((other.low - high).array() <= gap).all();
  }
};

Box boxOf(const TriangleMesh& mesh) {
  return {mesh.vertices.rowwise().minCoeff(), mesh.vertices.rowwise().maxCoeff()};
}

Box boxOf(const TriangleMesh& mesh, Index t) {
  const Vector3d a = mesh.corner(t, 0), b = mesh.corner(t, 1), c = mesh.corner(t, 2);
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

double sizeOf(const Box& box) { return (box.high - box.low).maxCoeff(); }

bool isInside(const Vector3d& x, const TriangleMesh& mesh) {
  double angle = 0;
  for (Index t = 0; t < mesh.triangleCount(); ++t) angle += solidAngle(mesh, t, x);
  return angle > 2 * kPi;
}

/// Edges of a through b, or corners of a closer to b than the gap.
bool reaches(const TriangleMesh& a, const TriangleMesh& b, double gap) {
  const Box box_of_b = boxOf(b);
  for (Index s = 0; s < a.triangleCount(); ++s) {
    const Box box = boxOf(a, s);
    if (!box.meets(box_of_b, gap)) continue;
    for (Index t = 0; t < b.triangleCount(); ++t) {
      if (!box.meets(boxOf(b, t), gap)) continue;
      for (int k = 0; k < 3; ++k) {
        if (distanceToTriangle(a.corner(s, k), b, t) < gap) return true;
        if (crossesTriangle(a.corner(s, k), a.corner(s, (k + 1) % 3), b, t)) return true;
      }
    }
  }
  return false;
}

}  // namespace

bool areInContact(const TriangleMesh& a, const TriangleMesh& b) {
  const double gap = kLeastGap * std::min(sizeOf(boxOf(a)), sizeOf(boxOf(b)));
  if (!boxOf(a).meets(boxOf(b), gap)) return false;
  return reaches(a, b, gap) || reaches(b, a, gap) || isInside(a.vertices.col(0), b) ||
         isInside(b.vertices.col(0), a);
}

}  // namespace ambient
