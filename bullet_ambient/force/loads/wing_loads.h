#pragma once

#include <array>
#include <memory>
#include <vector>

#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/loads/surface_loads.h"

namespace ambient {

/// Factors of eq. (118) on what stall takes from Munk's moment.
struct MunkShares {
  double rest = 1, wings = 1;
};

/// Form law on the wings of a body that has several parts: on the faces of each, and FormLift at
/// the two Gauss points of its span; and FormLift of the rest. docs/theory.md eq. (160). Frame F.
/// Takes energy only, as each of them does.
class WingLoads {
 public:
  /// rest: the first of LoadTables::parts().
  WingLoads(const BodyPart& rest, double stall_lag);

  /// on_faces: pressure on the faces of `wing`.
  void add(std::shared_ptr<const SurfaceLoads> on_faces, const BodyPart& wing, double stall_lag);
  /// Pressure on the faces of all wings, or with `wet` on those in the fluid.
  Wrench onFaces(const Twist& x, const WetPart* wet) const noexcept;
  /// Lift of rotation and loss of Munk's moment of rest and wings, about F's origin.
  Wrench lift(const Twist& x, double density, const MunkShares& munk,
              const WetPart* wet) const noexcept;
  /// Number of faces that one evaluation sums.
  int faces() const noexcept;

 private:
  struct One {
    std::shared_ptr<const SurfaceLoads> on_faces;
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
