#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace ambient::reference {

/// Added mass per unit density of flat sheets of zero thickness in the x-y plane, about the centre:
/// the three entries that are not 0.
struct SheetAddedMass {
  double w_x, w_y, v_z;
};

/// Circular disk of radius a [m]. Lamb, Hydrodynamics, 6th ed., art. 108.
inline SheetAddedMass diskAddedMass(double a) {
  const double a5 = std::pow(a, 5);
  return {16.0 / 45.0 * a5, 16.0 / 45.0 * a5, 8.0 / 3.0 * a * a * a};
}

/// Elliptic disk with semi-axes 2 and 1: limit of Lamb's ellipsoid, K_vz = 4/3 pi a b^2 / E, with E
/// the complete elliptic integral of the second kind. Checked against the ellipsoid of thickness
/// 1e-7.
inline SheetAddedMass ellipticDisk21AddedMass() {
  return {0.7952296188000137, 4.391314229675565, 6.917582852374852};
}

/// Rectangle of width 1 along y and length 1, 2 or 4 along x: hypersingular Galerkin solutions on
/// graded meshes, Richardson extrapolated; relative uncertainty 2.3e-5 in w, 1e-5 in v. v_z also in
/// Meyerhoff 1970.
inline SheetAddedMass rectangleAddedMass(int length) {
  switch (length) {
    case 1:
      return {0.02006632645189589, 0.020066324715834742, 0.45475441745843426};
    case 2:
      return {0.044566633979973964, 0.2590180648712568, 1.1888968942746714};
    default:
      return {0.09365025603441024, 2.8631857593998693, 2.739180274446267};
  }
}

}  // namespace ambient::reference
