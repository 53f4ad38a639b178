#pragma once

#include <memory>

#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/surface/wetted_inertia.h"
#include "bullet_ambient/motion/body/body_model.h"

namespace ambient {

class LoadTables;

/// A body and the two fluids that it may be between.
struct SurfaceModelDef {
  std::shared_ptr<const FluidBody> shape;
  FrameOffset fluid_frame;  ///< F in B
  MassProperties mass;
  Medium above, below;
  FlowSettings flow{};
  double wave_damping = 1;  ///< factor on the waves that the body makes, docs/theory.md eq. (69)
};

/// Loads of one of the fluids on the part of the body that is in it.
struct PartLoads {
  std::shared_ptr<const SurfaceLoads> loads;  ///< null: there are none
  FrameOffset frame;                          ///< theirs, in B
};

/// All that the motion near a water surface needs to know of one body; constant between changes of
/// body or media. Frame: body frame B, but for what is named otherwise.
struct SurfaceModel {
  BodyModel above, below;  ///< all of the body in one of the fluids
  FrameOffset fluid_frame;
  double excess_density = 0;  ///< of the fluid below over that above [kg/m^3]
  std::shared_ptr<const FluidBody> shape;
  std::shared_ptr<const PackedHull> hull;  ///< null for a sphere
  std::shared_ptr<const WettedInertia> wetted;
  PartLoads loads_above, loads_below;
  double radius = 0;        ///< of a sphere about the centre of mass that holds the body [m]
  double heave_factor = 1;  ///< c of docs/theory.md eq. (69)
  double wave_damping = 1;
};

/// Cost: makeBodyModel() twice, and the tables of the shape if they are new. Loads of the fluid
/// above are made if its density is a hundredth of the other or if it moves.
/// @throws std::invalid_argument, naming value and limit, as makeBodyModel() and
/// makeSurfaceLoads(); if the fluid above is the denser one; if the body has a volume and no
/// triangles.
SurfaceModel makeSurfaceModel(const SurfaceModelDef& def, LoadTables& tables);

/// Side of the surface on which a body is.
enum class SurfaceSide { kAbove, kAt, kBelow };

/// Whether the surface matters to a body that moves by at most `travel` [m]: at kAbove and kBelow
/// it moves as in one of the fluids alone. The plane in B. Cost: 5 ns where the surface is far.
SurfaceSide sideOf(const SurfaceModel& model, const SurfacePlane& plane_B, double travel) noexcept;

/// In F, for a plane in B.
Immersion immersionOf(const SurfaceModel& model, const SurfacePlane& plane_B) noexcept;

/// Total inertia of body and fluids in B at an immersion; docs/theory.md eq. (63). Positive
/// definite but for errors of the wetted part.
Matrix6 inertiaAt(const SurfaceModel& model, const Immersion& immersion) noexcept;

/// A total inertia without what makes it indefinite: the wetted part loses its negative part.
Matrix6 positiveInertia(const SurfaceModel& model, const Matrix6& inertia) noexcept;

}  // namespace ambient
