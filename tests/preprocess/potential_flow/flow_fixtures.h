#pragma once

#include <algorithm>
#include <cmath>

#include "preprocess/mesh/mass_properties.h"
#include "preprocess/potential_flow/results/potential_flow.h"
#include "tests/preprocess/mesh/mesh_fixtures.h"

namespace ambient::test {

inline Matrix6 addedMassOf(const TriangleMesh& mesh) { return solvePotentialFlow(mesh).added_mass; }

inline Matrix6 addedMassOf(const TriangleMesh& mesh, double volume) {
  return addedMassOf(withVolume(mesh, volume));
}

inline Matrix6 sheetAddedMassOf(const TriangleMesh& mesh) {
  PotentialFlowSettings settings;
  settings.sheet = true;
  return solvePotentialFlow(mesh, settings).added_mass;
}

inline double relativeError(double value, double reference) {
  return std::abs(value / reference - 1);
}

/// Largest difference of two inertias over the largest entry, lengths in units of `length`.
inline double differenceOf(const Matrix6& a, const Matrix6& b, double length = 1) {
  Vector6 units;
  units << Vector3::Constant(length), Vector3::Ones();
  const auto scaled = [&](const Matrix6& K) {
    return Matrix6(units.cwiseInverse().asDiagonal() * K * units.cwiseInverse().asDiagonal());
  };
  return (scaled(a) - scaled(b)).cwiseAbs().maxCoeff() / scaled(b).cwiseAbs().maxCoeff();
}

/// A closed body without symmetry: a bent, tapered, twisted box.
inline TriangleMesh skewBody(TriangleMesh box) {
  for (Eigen::Index v = 0; v < box.vertexCount(); ++v) {
    const Eigen::Vector3d p = box.vertices.col(v);
    const double taper = 1 + 0.3 * p.z() + 0.15 * p.x();
    const Eigen::Vector3d bent(p.x() * taper + 0.3 * p.z() * p.z(), p.y() * taper - 0.2 * p.x(),
                               p.z() + 0.1 * p.y() * p.y());
    box.vertices.col(v) = Eigen::AngleAxisd(0.6 * p.z(), Eigen::Vector3d::UnitZ()) * bent;
  }
  return box;
}

}  // namespace ambient::test
