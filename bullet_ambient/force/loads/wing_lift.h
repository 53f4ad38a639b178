#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "bullet_ambient/force/loads/load_tables.h"
#include "bullet_ambient/force/medium/surface_plane.h"

namespace ambient {

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
  /// in the fluid; null: all of it is. munk_of_rest, munk_of_wings: factors of eq. (118) on what
  /// stall takes from Munk's moment.
  Wrench load(const Twist& x, double density, double munk_of_rest, double munk_of_wings,
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
  /// A wing, with what its section adds to a plate, docs/theory.md eq. (166), (161b), (161e); power
  /// <= 0 with that of the plate.
  struct One {
    One(const Wing& wing, const BodyPart& part, double stall_lag);
    bool isFlat() const { return camber == 0 && nose == 0; }
    /// Force of the section per rho/2 and area for the velocity u of a place of the wing relative
    /// to the fluid; stalling: 1 - chi of eq. (161) [m^2/s^2].
    Vector3 sectionForce(const Vector3& u, double stalling) const noexcept;
    /// Velocity across the wing, along z, whose lift it has at such a place, with the share of its
    /// flow that is attached [m/s].
    Vector3 liftingVelocity(const Vector3& u, double stalling) const noexcept;
    double attachedShare(double across, double stalling, double speed_sq) const noexcept;

    ShapeFactors shape;
    FormLift half;  ///< of half of the wing
    std::array<WingHalf, 2> halves;
    double planform;  ///< of half of the wing [m^2]
    double camber, nose;
    double tail_drag = 0;     ///< C_t of eq. (161e)
    double induced, suction;  ///< K^2/(pi L); K (1 - K/(pi L)) without kappa
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
