#pragma once

#include "bullet_ambient/force/sphere_table.h"

namespace ambient {

/// One node of a SphereTable, by quadrature: over longitude about the velocity at equal steps, over
/// latitude by Gauss's rule between the places where the flow separates. Measured error 1e-5.
SphereIntegrals integrateSphere(double spin_share, double cosine,
                                double separation_cosine) noexcept;

}  // namespace ambient
