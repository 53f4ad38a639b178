#pragma once

#include "bullet_ambient/fluid_body/packed/packed_shape.h"
#include "bullet_ambient/force/surface/hydrostatics.h"

namespace ambient {

/// A hold for hydrostatics, in frame F.
class HoldShape {
 public:
  explicit HoldShape(const Hold& hold)
      : hull_(hold.surface), capacity_(hold.volume), turning_inertia_(hold.turning_inertia) {}

  const PackedHull& hull() const { return hull_; }
  double capacity() const { return capacity_; }  ///< [m^3]
  /// Hold::turning_inertia [m^5].
  const Matrix3& turningInertia() const { return turning_inertia_; }

 private:
  PackedHull hull_;
  double capacity_;
  Matrix3 turning_inertia_;
};

/// Water in a hold, level along a normal.
struct HoldFill {
  double height = 0;  ///< of its level along the normal [m]
  /// Full or empty: without a waterplane. Else its volume is the one given.
  WetVolume water;
  int clips = 0;  ///< how often the hold was clipped
};

/// Finds the level of water in a hold: Newton's method on V(h), whose derivative is the area of the
/// level, between brackets, docs/theory.md eq. (136). Cost: two to four computeWetVolume() from a
/// good guess; allocates nothing.
/// @param shape the hold, in the frame of the normal
/// @param normal unit, out of the water
/// @param volume [m^3]; up to 1e-12 of the hold it is empty, from 1 - 1e-12 on full
/// @param guess height to begin with, such as the last one [m]; NaN: the share of the hold's height
HoldFill fillHold(const HoldShape& shape, const Vector3& normal, double volume,
                  double guess) noexcept;

/// Takes what stands in a hold off the wet part of a closed vessel, docs/theory.md eq. (135).
/// Volume, moment and depth integral become those of both; the waterplane remains that outside.
/// @param wet of the closed vessel below the plane; in the frame of both planes
/// @param plane of the water outside
/// @param fill of the hold, by fillHold() along the same normal
WetVolume withWaterInside(WetVolume wet, const SurfacePlane& plane, const HoldFill& fill) noexcept;

}  // namespace ambient
