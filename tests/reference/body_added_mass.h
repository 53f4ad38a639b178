#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace ambient::reference {

/// Added mass per unit density of a body of revolution about z, about the origin. Entries not
/// listed are 0 or follow by symmetry: K[w_y, v_x] = -K[w_x, v_y].
struct RevolutionAddedMass {
  double v_z, v_x, w_y, coupling;
};

// Solutions of the axisymmetric boundary integral equation, 16-point panels graded dyadically to
// the edges; the same program agrees with Lamb's spheroid to 2e-15. Uncertainty 2e-9.

/// Half a unit ball, z > 0, about the ball's centre.
inline RevolutionAddedMass hemisphereAddedMass() {
  const double volume = 2.0 / 3.0 * std::acos(-1.0);
  return {1.2151482353124803 * volume, 0.368533971412441 * volume, 0.2314263542669546,
          0.09588537248611967};
}

/// Radius 1, height 2, about the centre.
inline RevolutionAddedMass cylinderAddedMass() {
  const double volume = 2 * std::acos(-1.0);
  return {0.5853635661072294 * volume, 0.579293987998501 * volume, 0.8098845194495637, 0};
}

/// Radius 1, height 0.2, about the centre.
inline RevolutionAddedMass coinAddedMass() {
  const double volume = 0.2 * std::acos(-1.0);
  return {4.864633361069023 * volume, 0.14245202593087108 * volume, 0.4092714516339417, 0};
}

/// Radius 1, cylindrical part of height 2, about the centre.
inline RevolutionAddedMass capsuleAddedMass() {
  const double volume = 10.0 / 3.0 * std::acos(-1.0);
  return {0.2331602152339004 * volume, 0.6964793056840268 * volume, 2.9488477137036364, 0};
}

/// Ring torus, radii 2 and 1, about the centre.
inline RevolutionAddedMass torusAddedMass() {
  const double volume = 4 * std::acos(-1.0) * std::acos(-1.0);
  return {1.0639074506992998 * volume, 0.3996840651707634 * volume, 60.06474834455299, 0};
}

/// K_v / volume of a cube in any direction, from the polarisability -(1 + K_v / volume) of a void:
/// Helsing and Perfekt, Applied and Computational Harmonic Analysis 34 (2013), table 1.
inline double cubeAddedMassCoefficient() { return 0.638415712936517; }

/// K_w of the cube of edge 2 about an axis through its centre; uncertainty 4e-4.
inline double cubeRotationalAddedMass() { return 1.2563629570258183; }

/// K_v / volume of the regular tetrahedron in any direction: Galerkin solutions, Richardson
/// extrapolated; uncertainty 2e-5.
inline double tetrahedronAddedMassCoefficient() { return 0.8070738790949269; }

/// Ellipsoid with semi-axes 1.2, 0.6, 1.0, cross-sections turned by z radians about z: a chiral
/// body. Diagonals of the three blocks, other entries 0. Fundamental solutions and extrapolated
/// Galerkin solutions agree; uncertainty 3e-6.
struct TwistedEllipsoidAddedMass {
  double w[3] = {0.1958336, 0.1518064, 0.2966526};
  double v[3] = {1.103731, 2.667684, 1.50394};
  double coupling[3] = {0.1830658, 0.142929, -0.3216112};
};

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
