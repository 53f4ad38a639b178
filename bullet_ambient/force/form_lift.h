#pragma once

#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// What the form law does to a body as a whole: the lift of its rotation, and what is lost of
/// Munk's moment and of the turning impulse where the flow has separated. docs/theory.md eq. (46)
/// to (50). Frame: that of the fluid body.
class FormLift {
 public:
  /// Cost: one eigenproblem of 3 rows. @pre stall_lag >= 0, in lengths of the body over its speed.
  FormLift(const FluidBody& body, double stall_lag);

  /// For a twist relative to the ambient flow, about F's origin. Without power, and homogeneous of
  /// degree 2 in the twist. Density [kg/m^3].
  Wrench load(const Twist& relative_twist, double density) const noexcept;

 private:
  void addStall(const Vector3& w, const Vector3& v, Wrench& about_centre) const noexcept;

  Matrix3 circulation_;  ///< B [m^3]
  Matrix3 direction_;    ///< D / d: how the added mass depends on the direction, at most 1
  double largest_;       ///< d [m^3]; 0: it does not, as that of a sphere or a cube
  double delay_;         ///< 2 kappa l [m]
  Vector3 centre_;       ///< of volume [m]
};

}  // namespace ambient
