#include "preprocess/mesh/holds/vessel.h"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/symmetric_eigen.h"

namespace ambient {

Rim rimOf(const HoldOpening& opening) {
  const auto count = static_cast<Eigen::Index>(opening.outline.size() / 3);
  const Eigen::Map<const Eigen::Matrix3Xd> corners(opening.outline.data(), 3, count);
  Rim rim;
  for (Eigen::Index i = 0; i < count; ++i)
    rim.length += (corners.col((i + 1) % count) - corners.col(i)).norm();
  rim.centre = (corners.rowwise().minCoeff() + corners.rowwise().maxCoeff()) / 2;
  return rim;
}

std::string holdText(const Hold& hold, double unit) {
  std::ostringstream text;
  text.precision(4);
  text << hold.name << " of " << unit * unit * unit * hold.volume << " m^3, ";
  if (hold.openings.empty()) text << "no opening";
  for (std::size_t i = 0; i < hold.openings.size(); ++i) {
    const Rim rim = rimOf(hold.openings[i]);
    const Vector3 centre = unit * rim.centre;
    text << (i == 0 ? "rim " : "; ") << unit * rim.length << " m round at (" << centre.x() << ", "
         << centre.y() << ", " << centre.z() << ")";
    if (hold.openings[i].to >= 0) text << " to hold " << hold.openings[i].to + 1;
  }
  return text.str();
}

Matrix3 turningInertia(const Matrix3& inertia) {
  const SymmetricEigen<3> principal = symmetricEigen<3>(inertia);
  const Vector3 squares =  // of the sides of the box with these moments
      6 * (Vector3::Constant(principal.values.sum()) - 2 * principal.values).cwiseMax(0);
  Vector3 turning;
  for (int axis = 0; axis < 3; ++axis)
    turning[axis] = boxTurning(squares[(axis + 1) % 3], squares[(axis + 2) % 3]);
  return principal.vectors * turning.asDiagonal() * principal.vectors.transpose();
}

TriangleMesh meshOf(const Surface& surface) {
  const auto vertices = static_cast<Eigen::Index>(surface.vertices.size() / 3);
  const auto triangles = static_cast<Eigen::Index>(surface.triangles.size() / 3);
  return {Eigen::Map<const Eigen::Matrix3Xd>(surface.vertices.data(), 3, vertices),
          Eigen::Map<const Eigen::Matrix3Xi>(surface.triangles.data(), 3, triangles)};
}

Surface surfaceOf(const TriangleMesh& mesh) {
  const double* vertices = mesh.vertices.data();
  const int* triangles = mesh.triangles.data();
  return {{vertices, vertices + mesh.vertices.size()},
          {triangles, triangles + mesh.triangles.size()}};
}

Hold moved(Hold hold, const Vector3& by) {
  const auto move = [&by](std::vector<double>& places) {
    for (std::size_t i = 0; i < places.size(); ++i) places[i] += by[static_cast<int>(i % 3)];
  };
  move(hold.surface.vertices);
  for (HoldOpening& opening : hold.openings) move(opening.outline);
  hold.centre += by;
  return hold;
}

TriangleMesh emptied(const std::vector<Hold>& holds) {
  std::vector<TriangleMesh> meshes;
  for (const Hold& hold : holds) {
    meshes.push_back(meshOf(hold.surface));
    meshes.back().triangles.row(1).swap(meshes.back().triangles.row(2));
  }
  return joinMeshes(meshes);
}

TriangleMesh wallsOf(const TriangleMesh& closed, const std::vector<Hold>& holds) {
  TriangleMesh all = joinMeshes({closed, emptied(holds)});
  using Corners = std::array<std::array<double, 3>, 3>;
  std::map<Corners, std::vector<Eigen::Index>> faces;
  for (Eigen::Index face = 0; face < all.triangles.cols(); ++face) {
    Corners corners;
    for (int k = 0; k < 3; ++k)
      Eigen::Map<Vector3>(corners[k].data()) = all.vertices.col(all.triangles(k, face));
    std::sort(corners.begin(), corners.end());
    faces[corners].push_back(face);
  }
  std::vector<Eigen::Index> kept;
  for (const auto& [corners, same] : faces)
    if (same.size() == 1) kept.push_back(same.front());
  std::sort(kept.begin(), kept.end());
  all.triangles = Eigen::Matrix3Xi(all.triangles(Eigen::all, kept));
  return all;
}

}  // namespace ambient
