#pragma once

#include "bullet_ambient/fluid_body/body_parts.h"
#include "bullet_ambient/force/law/face_pressure.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Slope of the normal force of a thin plate of aspect ratio L, docs/theory.md eq. (43c): Helmbold
/// 1942. It is that of a slender wing, pi L/2 (Jones 1946), for small L, and 2 pi for large L.
double normalForceSlope(double aspect);

/// sigma of eq. (43a): sine of the incidence at which much of the flow around a plate separates.
double stallSine(double aspect);

/// A shape as the form law sees it: its numbers, and the constants that follow from them.
struct ShapeFactors {
  explicit ShapeFactors(const FormShape& shape);
  /// A wing of a body that has several parts, docs/theory.md eq. (156) to (158).
  /// @param wing its numbers
  /// @param share W of eq. (158)
  ShapeFactors(const Wing& wing, double share);

  /// False of blocks: their faces follow eq. (43) without wings and slender hulls.
  bool actOnFaces() const { return shape.isWing() || shape.isSlender(); }
  /// Share of the load that waits for the wake, 1 - epsilon of eq. (51d): 0 of boxes and plates.
  double wakeShare() const;
  /// 1 - chi of eq. (161) in a motion about F's origin; 1 of a body that is one part. `length`:
  /// unit of length of the motion [m].
  double stallingShare(const Vector3& w, const Vector3& v, double length = 1) const;

  FormShape shape;
  double slope, slope_along;  ///< K and K' of eq. (43c)
  double stall_sine;          ///< sigma of eq. (43a)
  Vector3 root{0, 0, 0};      ///< of a wing: the end of its span at the joint [m]
  Vector3 reach{0, 0, 0};     ///< of a wing: b h; else 0 [m]
  WingFactors<float> in_single;
  WingFactors<double> in_double;
};

/// Part of the form law that acts on a body as a whole: lift of the rotation, eq. (46), (47), and
/// the loss of Munk's moment and of the turning impulse in separated flow, docs/theory.md eq. (48)
/// to (50). Frame F.
class FormLift {
 public:
  /// Cost: one eigenproblem of 3 rows.
  /// @pre stall_lag >= 0, in lengths of the body over its speed.
  FormLift(const LiftedPart& part, const ShapeFactors& factors, double stall_lag);

  /// Wrench about the centre of the part for the motion there relative to the ambient flow; density
  /// [kg/m^3]. Its power is 0. Homogeneous of degree 2 in the motion. munk_factor: factor of eq.
  /// (118) on the loss; stalling: 1 - chi of eq. (161), on the lag of a wing, eq. (161d).
  Wrench load(const Vector3& w, const Vector3& v, double density, double munk_factor = 1,
              double stalling = 1) const noexcept;

 private:
  /// 1 - f of eq. (49) and (49a); phi: sin^2 of the incidence, turning: what the lag takes from it.
  double separatedShare(double phi, double turning) const noexcept;
  void addStall(const Vector3& w, const Vector3& v, double munk_factor, double stalling,
                Wrench& about_centre) const noexcept;

  Matrix3 circulation_;  ///< B [m^3]
  Matrix3 direction_ =
      Matrix3::Zero();   ///< D / d, eigenvalues in [0, 1]: directional part of the added mass
  double largest_ = 0;   ///< d [m^3]; 0: same added mass in all directions, as of sphere or cube
  double delay_ = 0;     ///< 2 lambda l of eq. (48) [m]
  double wing_;          ///< W
  double attached_ = 1;  ///< f_0: circulation of a wing over that of an endless one
  double stall_sq_ = 1;  ///< sigma^2
};

}  // namespace ambient
