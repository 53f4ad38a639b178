#pragma once

#include <Eigen/Core>
#include <vector>

#include "bullet_ambient/fluid_body/cluster_block.h"
#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Error of a level over sampled motions, relative to S = 1/2 rho sum A_i |u_s,i|^2 over all faces;
/// torques about the centre, over the length. docs/theory.md section "Reduced loads".
struct LoadLevelError {
  double maximum = 0;  ///< after local ascent from the worst samples; not a bound
  double p99 = 0;      ///< exceeded by one sample in a hundred
  double rms = 0;
  double broadside = 0;  ///< largest for translations near the direction of the largest projected
                         ///< area, relative to the load itself
  double friction = 0;   ///< p99 of the friction, relative to that on all faces together
};

/// Surface loads on few clusters in place of all faces, for one separation angle.
struct LoadLevel {
  int clusters = 0;
  double separation_angle = 0;        ///< [rad]
  Vector3 centre{0, 0, 0};            ///< of the area, in F [m]
  double length = 1;                  ///< root mean square of the faces' distances from it [m]
  Eigen::Matrix<double, 6, 21> even;  ///< part that all faces share, per products x_i x_j, i <= j
  std::vector<ClusterBlock> blocks;   ///< the last one ends with clusters that are zero
  LoadLevelError error;
  double cost = 0;  ///< of one evaluation, in faces that would cost as much: some 100 less with
                    ///< friction, 100 more without
};

}  // namespace ambient
