#pragma once

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"
#include "bullet_ambient/immersed/surface_media.h"

AMBIENT_BEGIN

/// True if a region has a water surface for the body: it has one, and gravity relative to the water
/// is not zero (no free fall).
bool hasSurface(const RegionSample& sample, const Vector3& gravity) noexcept;

/// Returns the surface near a position as a plane in W: normal against gravity as the water feels
/// it, g - a; through the surface point straight above or below the position. @pre hasSurface()
SurfacePlane planeNear(const Vector3& position, const RegionSample& sample,
                       const Vector3& gravity) noexcept;

/// Index of the entry with this kind; -1: none.
int findSurface(const std::vector<SurfaceMedia>& surfaces, const SurfaceKind& kind) noexcept;

/// Decides whether the surface matters to the body in a step of `duration` [s], and if so fills
/// AmbientBody::encounter. `sample`: region at the centre of mass. Without gravity there is no
/// surface, and the centre of mass decides. Allocates nothing.
SurfaceSide meetSurface(AmbientBody& ambient, const SurfaceKind& kind, const RegionSample& sample,
                        double duration) noexcept;

/// Returns the SurfaceStand of the body for a plane in B. Reuses the last one if the plane equals
/// SurfaceEncounter::met_B up to the rounding of poses in Bullet. The result depends on met_B
/// alone, so that a restored state continues with the same bits. Allocates nothing. @pre it is at a
/// surface
const SurfaceStand& standAt(AmbientBody& ambient, const SurfacePlane& plane_B) noexcept;

/// Returns the model of the body at its present pose: AmbientBody::model, or at a water surface the
/// model for the present waterline.
BodyModel modelNow(const AmbientBody& ambient);

/// Sets AmbientBody::model to the model at the present pose and waterline. Allocates nothing. @pre
/// the body is at a surface
void freezeAtSurface(AmbientBody& ambient) noexcept;

/// Sets AmbientBody::model to the model of the last SurfaceStand, found by passWithRows().
/// Allocates nothing. @pre the body is at a surface
void freezeAsStood(AmbientBody& ambient) noexcept;

/// Returns the change of velocity in B by the waves that the body makes and by the wind, over a
/// step in which rows move it; keeps the waves after the step. Allocates nothing. @pre the model is
/// frozen at this pose
Vector6 kickByWavesAndWind(AmbientBody& ambient, double duration) noexcept;

/// Stiffens the model for a step with rows that is long against the floating period, so that
/// buoyancy does not push the body past its balance; docs/theory.md eq. (68). Reports a step of
/// more than a quarter of the period once; apart from that allocates nothing.
void stiffenForRows(AmbientBody& ambient, double duration, Complaints& complaints) noexcept;

/// Restores the model of a saved state: as freezeAtSurface() left it for `met_B`. Call between
/// steps.
/// @pre met_B is set; `media` is an index into AmbientBody::surfaces
void freezeAsMet(AmbientBody& ambient, int media) noexcept;

/// Returns the twist x of a body that Bullet has moved with rows, after the change of its added
/// mass on the way; in B, relative to the water. Removes energy above the work of weight and
/// buoyancy, docs/theory.md eq. (68a). Axes::kLocked: removes only the energy that the change of
/// added mass would add.
enum class Axes { kFree, kLocked };
BoundedTwist passWithRows(AmbientBody& ambient, const Vector6& x, Axes axes,
                          double duration) noexcept;

/// Returns the energy of the water that the body lifts or displaces [J], at a pose B to W that the
/// step may reach a time `duration` [s] after freezeAtSurface(). @pre the body is at a surface
double hydrostaticEnergyAt(const AmbientBody& ambient, const FrameOffset& pose,
                           double duration) noexcept;

/// True if a body that hardly moves may fall asleep where it floats: its balance is stable.
bool mayRestAtSurface(AmbientBody& ambient) noexcept;

AMBIENT_END
