#pragma once

#include <array>
#include <memory>
#include <vector>

#include "bullet_ambient/force/law/form_law.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/force/loads/wing_lift.h"

namespace ambient {

/// Point of a measured polar.
struct FoilPoint {
  double incidence = 0;  ///< [rad], -pi to pi
  double lift = 0;       ///< C_L on span times chord
  double drag = 0;       ///< C_D, >= 0
};

/// A wing, fin or rudder written by hand: a rectangle that is no part of the mesh. It has neither
/// volume nor mass. Frame F of the fluid body that it is on.
struct Foil {
  Vector3 position{0, 0, 0};    ///< of its middle; with a polar where its forces act [m]
  Vector3 chord_axis{1, 0, 0};  ///< towards the leading edge
  Vector3 span_axis{0, 1, 0};   ///< h, made perpendicular to it; z = chord x span is its upper side
  double span = 0;              ///< b [m]
  double chord = 0;             ///< c [m]
  double thickness = 0;         ///< t, mean, at most 0.3 c; above 0.04 c its nose is round [m]
  double camber = 0;            ///< zeta: rise of the mean line over the chord, from -0.2 to 0.2
  double drag = 0.01;           ///< C_D of its profile at no lift
  double aspect = 0;            ///< L; 2 b/c of a fin on a wall; 0: b/c
  /// From -pi to pi, or from 0 to pi: the same on both sides. In place of the law of wings,
  /// thickness, camber, drag and aspect. Empty: none.
  std::vector<FoilPoint> polar = {};
};

/// Foils of one body: each lifts by the law of wings, docs/theory.md section 22. Their angles may
/// change between two steps; all else stays. A body whose foils turn alone has its own Foils.
class Foils {
 public:
  /// @throws std::invalid_argument, one line that names the number of the foil, value and limit
  explicit Foils(const std::vector<Foil>& foils);

  std::size_t size() const noexcept { return placed_.size(); }
  const Foil& foil(std::size_t index) const { return placed_.at(index).foil; }
  /// Turns a foil about its span, right-handed [rad], from the place in which it was given.
  /// @throws std::invalid_argument if the angle is not finite
  void turn(std::size_t index, double angle);
  double angle(std::size_t index) const { return placed_.at(index).angle; }
  /// Columns: its chord towards the leading edge, its span, its upper side.
  const Matrix3& axesOf(std::size_t index) const { return placed_.at(index).pose.rotation; }

  /// Returns the wrench about F's origin of one foil for a twist relative to the fluid; density
  /// [kg/m^3]. `wet`: of the part in the fluid; null: all of it is. Power <= 0.
  Wrench load(std::size_t index, const Twist& x, double density, const WetPart* wet) const noexcept;
  /// Returns the sum over all foils.
  Wrench load(const Twist& x, double density, const WetPart* wet) const noexcept;
  /// Largest distance of a foil's corner from a point [m].
  double reachFrom(const Vector3& point) const noexcept;

 private:
  /// A foil in its place. Its own frame: x along the chord, y along the span.
  struct Placed {
    Foil foil;
    double angle = 0;
    Matrix3 axes = Matrix3::Identity();       ///< of its frame in F, at no angle
    FrameOffset pose;                         ///< of its frame in F
    ShapeFactors shape;                       ///< of its Wing
    std::shared_ptr<const SurfaceLoads> law;  ///< of wings, per unit density; null: a polar
    std::array<WingHalf, 2> halves;
    double mass = 0;  ///< k / 2 [m^3]
  };

  static Placed place(const Foil& foil, std::size_t index);
  static Wrench atStation(const Placed& placed, const Vector3& station, const Twist& x) noexcept;
  static Vector3 byPolar(const Foil& foil, const Vector3& u) noexcept;

  std::vector<Placed> placed_;
};

/// Adds the loads of foils to those of a body in a fluid of a density [kg/m^3]. `on_body`: null:
/// none.
std::shared_ptr<const SurfaceLoads> addFoils(std::shared_ptr<const SurfaceLoads> on_body,
                                             std::shared_ptr<const Foils> foils, double density);

}  // namespace ambient
