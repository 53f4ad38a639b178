#pragma once

#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/complaints.h"
#include "bullet_ambient/immersed/surface_media.h"

AMBIENT_BEGIN

/// Whether water lies still somewhere: not without gravity, and not in free fall.
bool hasSurface(const RegionSample& sample, const Vector3& gravity) noexcept;

/// The surface as a plane in W: against gravity as the water feels it, through the point of the
/// surface above a position. @pre hasSurface()
SurfacePlane planeNear(const Vector3& position, const RegionSample& sample,
                       const Vector3& gravity) noexcept;

/// The index of a kind; -1: none.
int findSurface(const std::vector<SurfaceMedia>& surfaces, const SurfaceKind& kind) noexcept;

/// The body is where the sample was taken: whether the surface matters to it in a step of
/// `duration` [s]; if it does, keeps what the step needs to know. Without gravity there is no
/// surface, and the centre of mass decides. Allocates nothing.
SurfaceSide meetSurface(AmbientBody& ambient, const SurfaceKind& kind, const RegionSample& sample,
                        double duration) noexcept;

/// The body against a plane in B; where that is the plane that it met last, but for the rounding of
/// its pose in Bullet, what is known of it already. A function of the encounter's plane alone, so
/// that a saved state goes on with the same bits. Allocates nothing. @pre it is at a surface
const SurfaceStand& standAt(AmbientBody& ambient, const SurfacePlane& plane_B) noexcept;

/// Total inertia and the fluids around the body as they are now: its model, or what it is at the
/// surface.
BodyModel modelNow(const AmbientBody& ambient);

/// Makes the body's model that of its pose now, against the surface. Allocates nothing. @pre it is
/// at a surface; below as well
void freezeAtSurface(AmbientBody& ambient) noexcept;

/// Makes the body's model that of its last stand: where passWithRows() has found it. Allocates
/// nothing. @pre it is at a surface
void freezeAsStood(AmbientBody& ambient) noexcept;

/// Returns the change of velocity in B by the waves that the body makes and by the wind, over a
/// step in which rows move it; keeps the waves after the step. Allocates nothing. @pre the model is
/// frozen at this pose
Vector6 kickByWavesAndWind(AmbientBody& ambient, double duration) noexcept;

/// Stiffens the model for a step with rows that is long beside the floating period: stiff
/// against going past its balance, docs/theory.md eq. (68). Allocates nothing, but for what it says
/// once of a step that is more than a quarter of the period.
void stiffenForRows(AmbientBody& ambient, double duration, Complaints& complaints) noexcept;

/// Between two steps, of a saved state: the model as freezeAtSurface() left it against `met_B`.
/// @pre `met_B` is known; `media` is one of the body's surfaces
void freezeAsMet(AmbientBody& ambient, int media) noexcept;

/// After Bullet has moved a body with rows: its twist in B, relative to the water, without the
/// energy that its buoyancy did not have, and after the change of its inertia on the way. With
/// locked axes, it loses what energy the change would give it, and nothing else.
enum class Axes { kFree, kLocked };
BoundedTwist passWithRows(AmbientBody& ambient, const Vector6& x, Axes axes,
                          double duration) noexcept;

/// Energy of the water that the body lifts or displaces at a pose, B to W, after a time since
/// freezeAtSurface() [J]: for a pose that the step has not come to. @pre it is at a surface
double hydrostaticEnergyAt(const AmbientBody& ambient, const FrameOffset& pose,
                           double duration) noexcept;

/// Whether a body that hardly moves may fall asleep where it floats. False on a saddle.
bool mayRestAtSurface(AmbientBody& ambient) noexcept;

AMBIENT_END
