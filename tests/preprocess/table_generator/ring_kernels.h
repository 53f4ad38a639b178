#pragma once

#include <Eigen/Core>

namespace ambient {

/// A point of a meridian: distance from the axis and height [m].
using MeridianPoint = Eigen::Vector2d;

/// Potential at a point of a ring of sources or dipoles around the axis, by wave number: 0 for
/// motions along the axis, 1 (cosine of the angle) for motions across.
struct RingKernel {
  double source[2];  ///< int cos(m t) / (4 pi R) dt [1/m]
  double dipole[2];  ///< int cos(m t) d/dn' 1 / (4 pi R) dt [1/m^2]
};

/// Closed forms in complete elliptic integrals, docs/theory.md eq. (75).
/// @pre the points differ and lie off the axis
RingKernel ringKernel(const MeridianPoint& target, const MeridianPoint& source,
                      const Eigen::Vector2d& source_normal);

}  // namespace ambient
