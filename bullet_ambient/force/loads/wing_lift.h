#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/medium/surface_plane.h"

namespace ambient {

/// Factors of eq. (118) on what stall takes from Munk's moment.
struct MunkFactors {
  double rest = 1, wings = 1;
};

/// Section of a wing: what it adds to a plate, docs/theory.md eq. (166), (161b), (161e). Power <= 0
/// with that of the plate.
class Profile {
 public:
  Profile(const Wing& wing, const ShapeFactors& shape);

  bool isFlat() const { return camber_ == 0 && nose_ == 0; }
  /// Force per rho/2 and area for the velocity u of a place of the wing relative to the fluid, in
  /// the axes of the wing's; stalling: 1 - chi of eq. (161) [m^2/s^2].
  Vector3 force(const Vector3& u, double stalling) const noexcept;
  /// Velocity across the wing, along z, whose lift it has at such a place, with the share of its
  /// flow that is attached [m/s].
  Vector3 liftingVelocity(const Vector3& u, double stalling) const noexcept;

 private:
  double attachedShare(double across, double stalling, double speed_sq) const noexcept;

  Vector3 normal_, chord_;  ///< z, and h x z
  double camber_, nose_;
  double tail_drag_ = 0;      ///< C_t of eq. (161e)
  double slope_;              ///< K
  double induced_, suction_;  ///< K^2/(pi L); K (1 - K/(pi L)) without kappa
  WingFactors<double> attached_;
};

/// Half of a wing around a station.
struct WingHalf {
  Vector3 station;      ///< Gauss point of the span [m]
  Vector3 span, chord;  ///< quarter of b along h, half of c across it [m]

  /// Share of it that is in the fluid.
  double wetShare(const WetPart& wet) const noexcept;
};

/// Returns the halves of a rectangle. `span`: b h; `chord`: c along the chord [m].
std::array<WingHalf, 2> halvesOf(const Vector3& centre, const Vector3& span, const Vector3& chord);

/// Lift of rotation and loss of Munk's moment of a body with wings: FormLift of each wing at the
/// two Gauss points of its span, and of the rest, docs/theory.md eq. (160). Frame F. Power 0.
class WingLift {
 public:
  /// parts: LoadTables::parts() of the body, the rest first.
  WingLift(const FluidBody& body, const std::vector<BodyPart>& parts, double stall_lag);

  /// Wrench about F's origin for a twist relative to the flow; density [kg/m^3]. `wet`: of the part
  /// in the fluid; null: all of it is.
  Wrench load(const Twist& x, double density, const MunkFactors& munk,
              const WetPart* wet) const noexcept;
  /// Returns what the section of a wing adds to the load on its faces, and at most the power that
  /// this takes.
  Wrench bySection(std::size_t wing, const Twist& x, double density, const WetPart* wet,
                   const Wrench& on_faces) const noexcept;
  /// Twist relative to the flow as a wing sees it behind others, docs/theory.md eq. (161c).
  Twist seenBy(std::size_t wing, const Twist& x, const WetPart* wet) const noexcept;
  /// True: a wing is in the wake of another one, with which the power of all may be above 0.
  bool hasWakes() const { return !wakes_.empty(); }

 private:
  struct One {
    FormLift half;  ///< of half of the wing
    std::array<WingHalf, 2> halves;
    ShapeFactors shape;
    Profile profile;
    double planform;  ///< of half of the wing [m^2]
  };
  /// Flow that a wing turns and another one feels.
  struct Wake {
    std::size_t from, to;
    Vector3 behind;  ///< d: along the chord of the first, to the second one
    double share;    ///< e
  };

  void addWake(const FluidBody& body, std::size_t from, std::size_t to);

  FormLift rest_;
  Vector3 rest_centre_;
  std::vector<One> wings_;
  std::vector<Wake> wakes_;
};

}  // namespace ambient
