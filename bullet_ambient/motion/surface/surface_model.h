#pragma once

#include <memory>

#include "bullet_ambient/force/law/flow_settings.h"
#include "bullet_ambient/force/surface/wetted_inertia.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/surface/hold_water.h"

namespace ambient {

/// Definition of a body and of the two fluids at a water surface.
struct SurfaceModelDef {
  std::shared_ptr<const FluidBody> shape;
  FrameOffset fluid_frame;  ///< pose of F in B
  MassProperties mass;
  Medium above, below;
  FlowSettings flow{};
  double wave_damping = 1;  ///< factor on the waves that the body makes, docs/theory.md eq. (69)
  double added_mass_factor = 1, load_factor = 1;  ///< as in AttachDef
};

/// Loads of one fluid on the part of the body in it.
struct PartLoads {
  std::shared_ptr<const SurfaceLoads> loads;     ///< null: there are none
  FrameOffset frame;                             ///< pose in B of the frame of the loads
  std::shared_ptr<const Resistance> resistance;  ///< of the loads, in B; null: none
};

/// Parameters of the motion of one body near a water surface; constant between changes of body or
/// media. Frame: body frame B, unless the name says otherwise.
struct SurfaceModel {
  /// Models of the whole body in one of the fluids; its holds are full of that above.
  BodyModel above, below;
  FrameOffset fluid_frame;
  double excess_density = 0;  ///< density of the fluid below minus that of the fluid above [kg/m^3]
  double added_density = 0;   ///< the same times the factor on the added mass
  double load_factor = 1;     ///< on the wind
  std::shared_ptr<const FluidBody> shape;
  std::shared_ptr<const PackedHull> hull;   ///< null for a sphere
  std::shared_ptr<const HoldShapes> holds;  ///< null: none
  std::shared_ptr<const WettedInertia> wetted;
  PartLoads loads_above, loads_below;
  double radius = 0;  ///< radius of a sphere about the centre of mass that contains the body [m]
  double heave_factor = 1;  ///< c of docs/theory.md eq. (69)
  double wave_damping = 1;
  /// Axis of a body of revolution whose own mass is round about it, too, in B: pressure and waves
  /// do not change its spin about that; else 0.
  Vector3 still_axis_B{0, 0, 0};

  /// Returns a change of spin in B without what it may not change, eq. (66a).
  Vector3 withoutStill(const Vector3& spin_B) const {
    return spin_B - still_axis_B.dot(spin_B) * still_axis_B;
  }
};

/// Makes the model. Makes loads of the fluid above only if its density is at least a hundredth of
/// that of the fluid below, or if it moves. Cost: makeBodyModel() twice, and the tables of the
/// shape if they are new.
/// @throws std::invalid_argument, naming value and limit, as makeBodyModel() and
/// makeSurfaceLoads(); if the fluid above is the denser one; if the body has a volume and no
/// triangles.
SurfaceModel makeSurfaceModel(const SurfaceModelDef& def);

/// Computes SurfaceModel::still_axis_B for the own mass of the body, with moments in B.
Vector3 stillAxisOf(const SurfaceModel& model, const MassProperties& mass);

/// Position of a body relative to the surface.
enum class SurfaceSide { kAbove, kAt, kBelow };

/// Decides whether the surface matters to a body that moves by at most `travel` [m]: kAbove and
/// kBelow mean that the body moves as in one fluid alone. `plane_B`: plane in B. Cost: 5 ns if the
/// surface is far.
SurfaceSide sideOf(const SurfaceModel& model, const SurfacePlane& plane_B, double travel) noexcept;

/// Computes the immersion in F, for a plane in B.
Immersion immersionOf(const SurfaceModel& model, const SurfacePlane& plane_B) noexcept;
/// Computes the wet volume in B for a plane in B, less the water in its holds, docs/theory.md eq.
/// (135). `water`: states of the holds; null: without water.
WetVolume wetVolumeAt(const SurfaceModel& model, const SurfacePlane& plane_B,
                      const HoldState* water) noexcept;

/// Computes the total inertia K of body and fluids in B at an immersion; docs/theory.md eq. (63).
/// Errors of the wetted part may make it smaller than that in the fluid above, see
/// positiveInertia().
Matrix6 inertiaAt(const SurfaceModel& model, const Immersion& immersion) noexcept;

/// Smallest total inertia that is taken as it is, in inertias in the fluid above [1].
constexpr double kLeastShare = 0.5;

/// Returns a total inertia whose parts below kLeastShare are raised, docs/theory.md eq. (63a), so
/// that it is positive definite.
Matrix6 positiveInertia(const SurfaceModel& model, const Matrix6& inertia) noexcept;

}  // namespace ambient
