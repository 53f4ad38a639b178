#pragma once

#include "bullet_ambient/spatial/vector_types.h"
#include "tests/reference/body_added_mass.h"

namespace ambient::study {

// Matrices from tests/reference, about the origin, rotation first.

inline Matrix6 matrixOf(const reference::RevolutionAddedMass& exact) {
  Vector6 diagonal;
  diagonal << exact.w_y, exact.w_y, 0, exact.v_x, exact.v_x, exact.v_z;
  Matrix6 K = diagonal.asDiagonal();
  K(1, 3) = K(3, 1) = exact.coupling;
  K(0, 4) = K(4, 0) = -exact.coupling;
  return K;
}

inline Matrix6 matrixOf(const reference::TwistedEllipsoidAddedMass& exact) {
  Matrix6 K = Matrix6::Zero();
  for (int k = 0; k < 3; ++k) {
    K(k, k) = exact.w[k];
    K(k + 3, k + 3) = exact.v[k];
    K(k, k + 3) = K(k + 3, k) = exact.coupling[k];
  }
  return K;
}

inline Matrix6 cubeAddedMass() {
  Vector6 diagonal;
  diagonal << Vector3::Constant(reference::cubeRotationalAddedMass()),
      Vector3::Constant(8 * reference::cubeAddedMassCoefficient());
  return diagonal.asDiagonal();
}

}  // namespace ambient::study
