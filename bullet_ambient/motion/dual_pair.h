#pragma once

#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// A vector of the space of twists and its image under the inertia K: a twist and its momentum, or
/// an acceleration and the wrench behind it; in B. Inner products in the metric of K, and sums,
/// need no product with K.
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

/// a.K b
inline double inner(const DualPair& a, const DualPair& b) { return a.twist.dot(b.momentum); }

}  // namespace ambient
