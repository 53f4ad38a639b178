#include "preprocess/mesh/union/solid_contact.h"

#include <algorithm>

#include "bullet_ambient/base/pi.h"
#include "preprocess/mesh/defects/surface_crossing.h"
#include "preprocess/mesh/geometry.h"

namespace ambient {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

bool isInside(const Vector3d& x, const TriangleMesh& mesh) {
  double angle = 0;
  for (Index t = 0; t < mesh.triangleCount(); ++t) angle += solidAngle(mesh, t, x);
  return angle > 2 * kPi;
}

/// Edges of a through b, or corners of a closer to b than the gap.
bool reaches(const TriangleMesh& a, const TriangleMesh& b, double gap) {
  const Eigen::AlignedBox3d bounds_of_b = b.bounds();
  for (Index s = 0; s < a.triangleCount(); ++s) {
    const Eigen::AlignedBox3d bounds = boundsOf(a, s);
    if (!areNear(bounds, bounds_of_b, gap)) continue;
    for (Index t = 0; t < b.triangleCount(); ++t) {
      if (!areNear(bounds, boundsOf(b, t), gap)) continue;
      for (int k = 0; k < 3; ++k) {
        if (isCloser(a.corner(s, k), b, t, gap)) return true;
        if (crossesTriangle(a.corner(s, k), a.corner(s, (k + 1) % 3), b, t)) return true;
      }
    }
  }
  return false;
}

}  // namespace

bool areInContact(const TriangleMesh& a, const TriangleMesh& b) {
  const double gap = kLeastGap * std::min(a.extents().maxCoeff(), b.extents().maxCoeff());
  if (!areNear(a.bounds(), b.bounds(), gap)) return false;
  return reaches(a, b, gap) || reaches(b, a, gap) || isInside(a.vertices.col(0), b) ||
         isInside(b.vertices.col(0), a);
}

}  // namespace ambient
