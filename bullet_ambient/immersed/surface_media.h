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

/// Loads on the wet part of a body; setPart() says which part is wet at present.
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

/// Model and loads of a body at the surface between two fluids.
struct SurfaceMedia {
  SurfaceKind kind;
  SurfaceModel model;
  std::shared_ptr<LoadsAtSurface>
      loads;               ///< loads of this body alone, not shared; null: there are none
  SurfaceStand stand;      ///< last result of standAt()
  bool has_stand = false;  ///< true: `stand` belongs to the present model
};

/// Encounter of a body with a surface in one step.
struct SurfaceEncounter {
  int media = -1;        ///< index into AmbientBody::surfaces; -1: no surface is near
  SurfacePlane plane_W;  ///< surface at the start of the step
  Vector3 velocity_above = Vector3::Zero();
  WaveMemory waves;            ///< waves that the body has made
  WaveMemory waves_with_rows;  ///< waves after the step, if rows move the body
  Vector6 twist_before_rows =
      Vector6::Zero();  ///< velocity in B, relative to the water, that constraint rows start from
  /// Plane of the surface in B at the exact pose where the last flight or step with rows ended,
  /// before Bullet rounded it.
  std::optional<SurfacePlane> met_B;
};

AMBIENT_END
