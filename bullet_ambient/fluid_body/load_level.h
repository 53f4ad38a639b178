#pragma once

#include <Eigen/Core>
#include <vector>

#include "bullet_ambient/fluid_body/cluster_block.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Error of a level over sampled motions, relative to S = 1/2 rho sum A_i |u_s,i|^2 over all faces.
/// Torques count about the level's centre, divided by its length. docs/theory.md section 9.
struct LoadLevelError {
  double maximum = 0;    ///< after local ascent from the worst samples; not a bound
  double p99 = 0;        ///< 99th percentile
  double rms = 0;        ///< root mean square
  double broadside = 0;  ///< largest error, relative to the load itself, for translations near the
                         ///< direction of the largest projected area
  double friction = 0;   ///< p99 of the friction, relative to the friction summed over all faces
};

/// Surface loads on a few clusters that replace all faces, for one separation angle.
struct LoadLevel {
  int clusters = 0;
  double separation_angle = 0;        ///< [rad]
  Vector3 centre{0, 0, 0};            ///< centroid of the surface, in F [m]
  double length = 1;                  ///< root mean square distance of the faces from centre [m]
  Eigen::Matrix<double, 6, 21> even;  ///< T of eq. (36), columns: products x_i x_j, i <= j
  std::vector<ClusterBlock> blocks;   ///< the last block is filled up with zeros
  LoadLevelError error;
  /// Time of one evaluation of the level, in units of the time that the sum over one face takes.
  /// The level is faster than the body's faces if this is below their number. An estimate: about
  /// 100 too high with friction, about 100 too low without.
  double cost = 0;
};

}  // namespace ambient
