#pragma once

#include <array>
#include <limits>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// A hold for hydrostatics, in frame F.
class HoldShape {
 public:
  /// Cost: some 150 computeWetVolume().
  explicit HoldShape(const Hold& hold);

  const PackedHull& hull() const { return hull_; }
  double capacity() const { return capacity_; }  ///< [m^3]
  /// Hold::turning_inertia [m^5].
  const Matrix3& turningInertia() const { return turning_inertia_; }
  /// Height of a level along a normal that is near to that of a volume, whatever was before: the
  /// level turns about its middle. Exact where walls stand along the axis of F that is nearest to
  /// the normal [m].
  double levelNear(const Vector3& normal, double volume) const noexcept;

 private:
  static constexpr int kLevels = 16;  // shares of the capacity

  PackedHull hull_;
  double capacity_;
  Matrix3 turning_inertia_;
  /// Middles of the levels along each axis of F, at 1/16 to 15/16 of the capacity [m].
  std::array<std::array<Vector3, kLevels - 1>, 3> middles_{};
};

/// Water in a hold, level along a normal.
struct HoldFill {
  double height = 0;  ///< of its level along the normal [m]
  /// Full or empty: without a waterplane. Else its volume is the one given.
  WetVolume water;
  int clips = 0;  ///< how often the hold was clipped
};

/// Finds the level of water in a hold: Newton's method on V(h), whose derivative is the area of the
/// level, between brackets, docs/theory.md eq. (136). Its last step, where it is small, moves the
/// level without another clip. Cost: one to three computeWetVolume(); allocates nothing.
/// @param shape the hold, in the frame of the normal
/// @param normal unit, out of the water
/// @param volume [m^3]; up to 1e-12 of the hold it is empty, from 1 - 1e-12 on full
/// @param guess height to begin with [m]; NaN: HoldShape::levelNear()
HoldFill fillHold(const HoldShape& shape, const Vector3& normal, double volume,
                  double guess = std::numeric_limits<double>::quiet_NaN()) noexcept;

/// Takes what stands in a hold off the wet part of a closed vessel, docs/theory.md eq. (135).
/// Volume, moment and depth integral become those of both; the waterplane remains that outside.
/// @param wet of the closed vessel below the plane; in the frame of both planes
/// @param plane of the water outside
/// @param fill of the hold, by fillHold() along the same normal
WetVolume withWaterInside(WetVolume wet, const SurfacePlane& plane, const HoldFill& fill) noexcept;

/// First mode of sloshing of the water in a hold along one axis of its level: a pendulum;
/// docs/theory.md eq. (149).
struct SloshMode {
  Vector3 axis{0, 0, 0};   ///< e: unit, along the level
  Vector3 bob{0, 0, 0};    ///< place of the mass that moves [m]
  Vector3 pivot{0, 0, 0};  ///< where it hangs: at rest there, the hold tilts around a still bob [m]
  double volume = 0;       ///< that mass, per unit density [m^3]; 0: there is no mode
  double square = 0;       ///< omega^2 [1/s^2]
  double farthest = 0;     ///< way at which the surface meets the floor or the top of the hold [m]
  double length = 0;       ///< l of the box with this level [m]
};

/// First mode of a box at its wall, over the plane with the same moment there [1].
constexpr double kWavePerPlane = kPi * kPi / 12;
/// Height over the level of a wave where it meets the wall, for a way q of its pendulum [m];
/// docs/theory.md eq. (154a).
inline double crestOf(const SloshMode& mode, double way, double gravity) noexcept {
  return kWavePerPlane * mode.square / gravity * way * mode.length / 2;
}

/// Level of the water in a hold and its motion: its two modes, and its resistance to turning.
struct HoldModes {
  SloshMode modes[2];
  double height = 0;                  ///< HoldFill::height, in F; without water of no meaning [m]
  Vector3 centre{0, 0, 0};            ///< of the water [m]
  Vector3 middle{0, 0, 0};            ///< of the level [m]
  Matrix3 turning = Matrix3::Zero();  ///< J about the centre, per unit density, eq. (151) [m^5]
};

/// Finds the modes along the principal axes of the level. Exact for boxes; of cylinders and half
/// balls omega is at most 1.5 % off, of round canals and V's 7 %. Full or empty holds have none.
/// `fill` is that of the hold by fillHold() along the normal of the plane, whose gravity is that
/// which the water feels. All but the height is in the frame in which F has the pose `frame`.
HoldModes modesOf(const HoldShape& shape, const HoldFill& fill, const SurfacePlane& plane_F,
                  const FrameOffset& frame = {}) noexcept;

/// Inertia of the water in a hold as it moves with the body, less that of its modes, per unit
/// density, about the origin of the frame of the modes; docs/theory.md eq. (150). Positive
/// semidefinite. `volume`: of the water, those of its modes included [m^3].
Matrix6 carriedInertia(double volume, const HoldModes& modes) noexcept;

/// Lines in which a plane cuts a closed surface: pairs of points, each with the inside on its left
/// seen from above, where the normal points.
std::vector<Vector3> cutAt(const Vector3& point, const Vector3& normal, const Surface& surface);

}  // namespace ambient
