#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Vector x and its image K x under the inertia: a twist and its momentum, or an acceleration and
/// its wrench; in B. Sums and inner products a.K b of pairs need no multiplication by K.
/// `twist`: x; `momentum`: K x.
struct DualPair {
  Vector6 twist = Vector6::Zero();
  Vector6 momentum = Vector6::Zero();

  DualPair& operator+=(const DualPair& other) {
    twist += other.twist;
    momentum += other.momentum;
    return *this;
  }
  friend DualPair operator+(DualPair a, const DualPair& b) { return a += b; }
  friend DualPair operator-(const DualPair& a, const DualPair& b) {
    return {a.twist - b.twist, a.momentum - b.momentum};
  }
  friend DualPair operator*(double s, const DualPair& a) { return {s * a.twist, s * a.momentum}; }
};

/// Inner product a.K b.
inline double inner(const DualPair& a, const DualPair& b) { return a.twist.dot(b.momentum); }

}  // namespace ambient
