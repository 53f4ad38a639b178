#pragma once

#include "bullet_ambient/spatial/vector_types.h"

namespace ambient {

/// Added mass per unit density of a body of revolution about z, about the origin. The coupling is
/// K[w_y, v_x] = -K[w_x, v_y]; all that is not listed is 0 or follows by symmetry.
struct RevolutionInertia {
  double v_z = 0, v_x = 0, w_y = 0, coupling = 0;

  Matrix6 matrix() const {
    Matrix6 K = Matrix6::Zero();
    K(0, 0) = K(1, 1) = w_y;
    K(3, 3) = K(4, 4) = v_x;
    K(5, 5) = v_z;
    K(1, 3) = K(3, 1) = coupling;
    K(0, 4) = K(4, 0) = -coupling;
    return K;
  }
};

}  // namespace ambient
