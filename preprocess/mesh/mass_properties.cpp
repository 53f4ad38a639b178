#include "preprocess/mesh/mass_properties.h"

#include <cmath>
#include <sstream>
#include <utility>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/base/elementary.h"
#include "preprocess/mesh/geometry.h"
#include "preprocess/mesh/input_error.h"
#include "preprocess/mesh/triangle_mesh.h"

namespace ambient {

namespace {

/// Integrals of 1, x and x x^T over a body or a distribution of points.
struct Moments {
  double mass = 0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
};

// Tetrahedron with one corner at the reference: int 1 = d/6, int x = d/24 s, int x x^T = d/120 (sum
// of p p^T + s s^T), with d = a . (b x c) and s = a + b + c.
Moments tetrahedronMoments(const TriangleCorners& p) {
  const double d = p.col(0).dot(p.col(1).cross(p.col(2)));
  const Eigen::Vector3d s = p.rowwise().sum();
  return {d / 6, d / 24 * s, d / 120 * (p * p.transpose() + s * s.transpose())};
}

// Triangle of uniform mass per area: A, A/3 s, A/12 (sum of p p^T + s s^T).
Moments triangleMoments(const TriangleCorners& p) {
  const double area = (p.col(1) - p.col(0)).cross(p.col(2) - p.col(0)).norm() / 2;
  const Eigen::Vector3d s = p.rowwise().sum();
  return {area, area / 3 * s, area / 12 * (p * p.transpose() + s * s.transpose())};
}

template <class MomentsOf>
Moments sumMoments(const TriangleMesh& mesh, const Eigen::Vector3d& reference,
                   MomentsOf momentsOf) {
  Moments sum;
  for (Eigen::Index t = 0; t < mesh.triangleCount(); ++t) {
    const Moments part = momentsOf(cornersOf(mesh, t).colwise() - reference);
    sum.mass += part.mass;
    sum.first += part.first;
    sum.second += part.second;
  }
  return sum;
}

// Rounding error of the sums over triangles, as a fraction of the body's size. Smaller deviations
// from a symmetric value count as 0.
constexpr double kRounding = 1e-12;

/// Exactly the origin or the middle of the body, along each axis, where rounding is all between.
Eigen::Vector3d withoutRounding(Eigen::Vector3d centre, const Eigen::Vector3d& middle,
                                double size) {
  for (int k = 0; k < 3; ++k) {
    for (const double exact : {middle[k], 0.0})
      if (std::abs(centre[k] - exact) <= kRounding * size) centre[k] = exact;
  }
  return centre;
}

/// Symmetric to the last bit, and diagonal where all but rounding is.
Eigen::Matrix3d withoutRounding(const Eigen::Matrix3d& spread) {
  Eigen::Matrix3d exact = (spread + spread.transpose()) / 2;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      if (i != j && std::abs(exact(i, j)) <= kRounding * spread.trace()) exact(i, j) = 0;
  }
  return exact;
}

// Two passes: the first finds the centre, the second integrates about it, where the second moments
// need no subtraction, and finds what rounding has left of the first.
template <class MomentsOf>
std::pair<double, MassDistribution> distributionOf(const TriangleMesh& mesh, MomentsOf momentsOf) {
  const Eigen::Vector3d middle = mesh.bounds().center();
  const Moments about_middle = sumMoments(mesh, middle, momentsOf);
  const Eigen::Vector3d centre = middle + about_middle.first / about_middle.mass;
  const Moments moments = sumMoments(mesh, centre, momentsOf);
  const Eigen::Vector3d residue = moments.first / moments.mass;
  const Eigen::Matrix3d spread = withoutRounding(Eigen::Matrix3d(moments.second / moments.mass));
  MassDistribution distribution;
  distribution.centre = withoutRounding(centre + residue, middle, mesh.extents().norm());
  distribution.inertia = spread.trace() * Eigen::Matrix3d::Identity() - spread;
  return {moments.mass, distribution};
}

}  // namespace

MeshProperties computeMassProperties(const TriangleMesh& mesh) {
  AMBIENT_ASSERT(isClosed(computeMeshEdges(mesh)));
  const auto [volume, inside] = distributionOf(mesh, tetrahedronMoments);
  const auto [area, shell] = distributionOf(mesh, triangleMoments);
  return {volume, area, inside, shell};
}

MeshProperties computeSheetMassProperties(const TriangleMesh& mesh) {
  const auto [area, sheet] = distributionOf(mesh, triangleMoments);
  return {0, area, sheet, sheet};
}

double sumOfVolumes(const std::vector<TriangleMesh>& meshes) {
  double sum = 0;
  for (const TriangleMesh& mesh : meshes) sum += computeMassProperties(mesh).volume;
  return sum;
}

TriangleMesh withVolume(TriangleMesh mesh, double volume) {
  const MeshProperties properties = computeMassProperties(mesh);
  const double stretch = portable::cbrt(volume / properties.volume);
  const Eigen::Vector3d centre = properties.uniform.centre;
  mesh.vertices = ((mesh.vertices.colwise() - centre) * stretch).colwise() + centre;
  return mesh;
}

namespace {

// Refuses bodies and sheets that are too narrow, with the limit of checkMesh(); generated shapes do
// not pass through that.
void requireUsualWidth(const MeshProperties& properties, double size, bool sheet,
                       const std::string& source) {
  constexpr double kLeastArea = 1e-12;
  const double width = properties.area / (size * size);
  if (!(width >= kLeastArea)) {
    raiseInputError(source, "it is too narrow: its area over the square of its size ",
                    "must be at least ", kLeastArea);
  }
  const double thickness = properties.volume / portable::pow(properties.area, 1.5);
  if (!sheet && !(thickness >= kLeastVolume)) {
    raiseInputError(source, "it is too thin: its volume over its area^1.5 is ", thickness,
                    ", at least ", kLeastVolume, " needed (a sheet has no thickness)");
  }
}

// Beyond these a file's unit is likelier to be another one than the body to be of that size: no
// ship is larger.
constexpr double kSmallestLikely = 1e-3, kLargestLikely = 500;  // [m]

}  // namespace

std::string extentsText(const Eigen::Vector3d& extents) {
  std::ostringstream text;
  text.precision(4);
  text << extents.x() << " x " << extents.y() << " x " << extents.z() << " m";
  return text.str();
}

std::string unlikelySizeWarning(const TriangleMesh& mesh, bool is_scaled,
                                const std::string& source) {
  const double size = mesh.extents().maxCoeff();
  if (size >= kSmallestLikely && (size <= kLargestLikely || is_scaled)) return {};
  return source + ": its size is " + extentsText(mesh.extents()) +
         (size > kLargestLikely
              ? "; lengths are metres: if the file is in millimetres, give a scale of 0.001"
              : "; lengths are metres: if the file is in others, give a scale");
}

MeshProperties requireUsualSize(const TriangleMesh& mesh, bool sheet, const std::string& source) {
  const double size = mesh.extents().norm();
  if (!(size >= kSmallestSize && size <= kLargestSize)) {
    const std::string limits = "; it must be 1e-9 m to 1e9 m";
    const std::string what = "the diagonal of its bounding box is ";
    if (!std::isfinite(size)) raiseInputError(source, what, "not finite", limits);
    raiseInputError(source, what, size, " m", limits);
  }
  MeshProperties properties = computeMassProperties(mesh, sheet);
  requireUsualWidth(properties, size, sheet, source);
  return properties;
}

}  // namespace ambient
