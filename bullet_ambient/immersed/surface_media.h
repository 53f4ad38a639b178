#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/immersed/region_fluids.h"
#include "bullet_ambient/motion/surface/surface_flight.h"
#include "bullet_ambient/motion/surface/surface_stand.h"

AMBIENT_BEGIN

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

/// Encounter of a body with a surface in one step.
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

AMBIENT_END
