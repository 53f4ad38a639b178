#pragma once

#include <array>
#include <vector>

#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/medium/surface_plane.h"

namespace ambient {

/// Factors of eq. (118) on what stall takes from Munk's moment.
struct MunkShares {
  double rest = 1, wings = 1;
};

/// Lift of rotation and loss of Munk's moment of a body with wings: FormLift of each wing at the
/// two Gauss points of its span, and of the rest, docs/theory.md eq. (160). Frame F. Power 0.
class WingLift {
 public:
  /// parts: LoadTables::parts(), the rest first.
  WingLift(const std::vector<BodyPart>& parts, double stall_lag);

  /// Wrench about F's origin for a twist relative to the flow; density [kg/m^3]. `wet`: of the part
  /// in the fluid; null: all of it is.
  Wrench load(const Twist& x, double density, const MunkShares& munk,
              const WetPart* wet) const noexcept;

 private:
  struct One {
    FormLift half;  ///< of half of the wing
    std::array<Vector3, 2> stations;
    Vector3 span, chord;  ///< quarter of b along h, half of c across it [m]

    /// Share of the half of the wing around a station that is in the fluid.
    double wetShareAt(const Vector3& station, const WetPart& wet) const noexcept;
  };

  FormLift rest_;
  Vector3 rest_centre_;
  std::vector<One> wings_;
};

}  // namespace ambient
