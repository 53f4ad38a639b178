#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bullet_ambient/bullet/complaints.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/region_fluids.h"
#include "bullet_ambient/bullet/region_id.h"
#include "bullet_ambient/force/fluid_region.h"
#include "bullet_ambient/force/surface_loads.h"
#include "bullet_ambient/motion/surface_flight.h"
#include "bullet_ambient/motion/surface_stand.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

struct AmbientBody;

/// Loads on the part of a body that is in the water, for the moment that it was last told of.
class LoadsAtSurface final : public SurfaceLoads {
 public:
  explicit LoadsAtSurface(std::shared_ptr<const SurfaceLoads> loads) : loads_(std::move(loads)) {}

  void setPart(const WetPart& part) noexcept { part_ = part; }
  Wrench load(const Twist& x) const noexcept override { return loads_->wetLoad(x, part_); }
  int faces() const noexcept override { return loads_->faces(); }
  bool needsGuard() const noexcept override { return loads_->needsGuard(); }

 private:
  std::shared_ptr<const SurfaceLoads> loads_;
  WetPart part_;
};

/// A body between two fluids of a region.
struct SurfaceMedia {
  SurfaceKind kind;
  SurfaceModel model;
  std::shared_ptr<LoadsAtSurface> loads;  ///< this body's own; null: there are none
  SurfaceStand stand;                     ///< the last one; see standAt()
  bool has_stand = false;                 ///< of the model as it is
};

/// How a body meets a surface, of which it moves in one step.
struct SurfaceEncounter {
  int media = -1;        ///< which of AmbientBody::surfaces; -1: the surface is far
  SurfacePlane plane_W;  ///< at the start of the step
  Vector3 velocity_above = Vector3::Zero();
  WaveMemory waves;                             ///< that the body has made
  WaveMemory waves_with_rows;                   ///< after the step, if rows move the body
  Vector6 twist_before_rows = Vector6::Zero();  ///< in B, relative to the water
  /// In B, at the pose where the last flight or step with rows ended: not where Bullet has rounded
  /// it to.
  std::optional<SurfacePlane> met_B;
};

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

/// Returns the change of velocity in B by the waves that the body makes and by the wind, over a
/// step in which rows move it; keeps the waves after the step. Allocates nothing. @pre the model is
/// frozen at this pose
Vector6 kickByWavesAndWind(AmbientBody& ambient, double duration) noexcept;

/// The same model for a step that rows move it by, where that is long beside its swing: stiff
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

/// Of a body that hardly moves: whether it may fall asleep where it floats. False on a saddle.
bool mayRestAtSurface(AmbientBody& ambient) noexcept;

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
