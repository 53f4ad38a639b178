#pragma once

#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// Conversions between vectors of Eigen and those of spatial_lanes.h, for ordinary sources that use
// its mathematics for one body.

namespace ambient {
namespace {

inline VectorsOf<double> plain(const Vector3& a) { return {a[0], a[1], a[2]}; }
inline SpatialsOf<double> plain(const Vector6& a) {
  return {{a[0], a[1], a[2]}, {a[3], a[4], a[5]}};
}
inline PairsOf<double> plain(const DualPair& a) { return {plain(a.twist), plain(a.momentum)}; }

inline SymmetricOf<double> plain(const Matrix6& m) { return SymmetricMatrix(m); }

inline Vector3 asEigen(const VectorsOf<double>& a) { return {a.x, a.y, a.z}; }
inline Vector6 asEigen(const SpatialsOf<double>& a) {
  return stack(asEigen(a.angular), asEigen(a.linear));
}

}  // namespace
}  // namespace ambient
