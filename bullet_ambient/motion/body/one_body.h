#pragma once

#include "bullet_ambient/motion/body/dual_pair.h"
#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// Conversions to use the arithmetic of several bodies for one: the body is in all lanes, and the
// result is read from the first. For ordinary sources; the instruction set is the baseline.

namespace ambient {
namespace {

inline Vectors inAllLanes(const Vector3& a) { return {all(a.x()), all(a.y()), all(a.z())}; }
inline Spatials inAllLanes(const Vector6& a) {
  return {{all(a[0]), all(a[1]), all(a[2])}, {all(a[3]), all(a[4]), all(a[5])}};
}
inline Pairs inAllLanes(const DualPair& a) { return {inAllLanes(a.twist), inAllLanes(a.momentum)}; }
inline FullMatrices inAllLanes(const Matrix6& a) {
  FullMatrices m;
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) m.entry(i, j) = all(a(i, j));
  return m;
}

inline Vector3 ofFirstLane(const Vectors& a) { return {a.x[0], a.y[0], a.z[0]}; }
inline Vector6 ofFirstLane(const Spatials& a) {
  return stack(ofFirstLane(a.angular), ofFirstLane(a.linear));
}
inline Matrix6 ofFirstLane(const FullMatrices& a) {
  Matrix6 m;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) m(i, j) = a.entry(i, j)[0];
  return m;
}

}  // namespace
}  // namespace ambient
