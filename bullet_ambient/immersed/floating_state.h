#pragma once

#include <optional>
#include <utility>

#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/immersed/ambient_body.h"
#include "bullet_ambient/immersed/warnings.h"

namespace ambient {

/// True if a region has a water surface for the body: it has one, and gravity relative to the water
/// is not zero (no free fall).
bool hasSurface(const RegionSample& sample, const Vector3& gravity) noexcept;

/// Returns what gravity is inclined by in a sample whose surface has a tilt, docs/theory.md eq.
/// (84) [m/s^2]. @pre hasSurface()
Vector3 leanOf(const RegionSample& sample, const Vector3& gravity) noexcept;

/// A body near the surface of a region.
struct NearSurface {
  SurfaceSide side = SurfaceSide::kAt;
  int media = -1;  ///< index into FluidModels::surfaces; -1: it meets no surface
  SurfacePlane plane_W = {}, plane_B = {};  ///< where it meets one
};
/// Decides whether the surface matters to the body in a step of `duration` [s]. `sample`: of the
/// region where the body is, at `point_W`. Without gravity there is no surface, and the place of
/// the sample decides. Allocates nothing.
NearSurface nearSurface(const AmbientBody& ambient, const MotionView& now, const SurfaceKind& kind,
                        const RegionSample& sample, const Vector3& point_W,
                        double duration) noexcept;

/// Fills AmbientBody::floating if the surface matters to the body; where sides of its pool cut
/// it and it is not dry, it does at any depth. Allocates nothing.
SurfaceSide enterSurface(AmbientBody& ambient, const NearSurface& near, const RegionSample& sample,
                         const PoolSides& sides_F) noexcept;

/// Computes the Flotations of up to kFlightsTogether bodies at poses when the step begins, side
/// by side. Keeps the last one if the plane in B equals lastPlane() up to `rounding` of poses in
/// Bullet. The result depends on lastPlane() alone, so that a restored state continues with the
/// same bits. Allocates nothing. @pre they are at a surface
void updateFlotations(AmbientBody* const* bodies, const RigidState* states, int count,
                      double rounding) noexcept;

/// Plane of the surface when the step begins, in B at a pose. @pre the body is at a surface
SurfacePlane planeAt(const AmbientBody& ambient, const RigidState& state) noexcept;
/// Twist in B relative to the water.
Vector6 twistInWater(const AmbientBody& ambient, const RigidState& state) noexcept;
/// Sets the plane of the flotation, in B; the flotation stays valid if it is the same.
void moveFlotationTo(const SurfacePlane& plane_B, FloatingState& floating) noexcept;
/// Computes the flotations of up to kFlightsTogether bodies at their planes, side by side, where
/// they are not valid. Allocates nothing.
void completeFlotationsOf(AmbientBody* const* bodies, int count) noexcept;
/// Model of a body with the inertia, displacement and loads of a flotation.
BodyModel modelAtFlotation(const SurfaceModel& at, const Flotation& flotation);

/// Returns the model of the body at its present pose: AmbientBody::model(), or at a water surface
/// the model for the present waterline.
BodyModel modelNow(const AmbientBody& ambient, const MotionView& now);

/// Finds the flotation of one body at its present pose. Allocates nothing. @pre the body is at a
/// surface
const Flotation& flotationNow(AmbientBody& ambient, const MotionView& now) noexcept;

/// Model of a body for a step in which rows or joints move it: at a water surface with the inertia,
/// displacement and loads of its flotation. Allocates nothing.
class StepModel {
 public:
  StepModel() = default;
  /// For a step of `duration` [s], see stiffen().
  StepModel(const AmbientBody& ambient, double duration) noexcept;
  StepModel(const StepModel&) = delete;
  StepModel& operator=(const StepModel&) = delete;

  /// Takes the flotation of a body. @pre it is at a surface, and flotationNow() or
  /// applyAddedMassChanges() has found its flotation
  void freeze(const AmbientBody& ambient) noexcept;
  /// Stiffens the model by `modes` for a step that is long against the floating period, so that
  /// buoyancy does not push the body past its balance; docs/theory.md eq. (68).
  void stiffen(const Flotation& flotation, const FloatingModes& modes, double duration) noexcept;
  /// Gives the model the buoyancy of another pose B to W, a time [s] after freeze(). Inertia and
  /// loads stay. Returns weight and buoyancy there, in B [N m, N].
  Vector6 floatAt(const AmbientBody& ambient, const FrameOffset& pose, double time) noexcept;

  const BodyModel& operator*() const noexcept { return *model_; }
  const BodyModel* operator->() const noexcept { return model_; }

 private:
  // Makes the model in place: a copy of it costs as much as making it.
  struct AtSurface {
    AtSurface(const SurfaceModel& at, const Flotation& flotation);
    BodyModel model;
  };

  const BodyModel* model_ = nullptr;
  std::optional<AtSurface> at_surface_;
};

/// Reports once a step with rows of more than a quarter of the floating period; apart from that
/// allocates nothing.
void warnOfShortPeriod(const AmbientBody& ambient, double duration, Warnings& warnings) noexcept;

/// Returns the change of velocity in B by the waves that the body makes and by the wind, over a
/// step in which rows move it; keeps the waves after the step. Allocates nothing. @pre
/// flotationNow()
Vector6 kickByWavesAndWind(AmbientBody& ambient, const RigidState& now, double duration) noexcept;

/// Returns the largest error of the work of a buoyancy that stays over a way, the right-hand side
/// of docs/theory.md eq. (81b) [J]. `speed`: of the fastest point of the body [m/s], over a time
/// [s].
double errorOfBuoyancy(const SurfaceModel& model, const SurfacePlane& plane, double speed,
                       double duration) noexcept;

/// Returns the part of a step, at most 1, that a body makes which rows may move: where weight and
/// water alone would bring it to a place of more energy than it had in all, the part that ends
/// where the energy reaches, and notes the impulse that stops it for applyAddedMassChanges();
/// docs/theory.md eq. (68c). `end`: the twist that it would move by without rows, in B, relative to
/// the water. Allocates nothing. @pre kickByWavesAndWind()
double reachWithRows(AmbientBody& ambient, const RigidState& start, const Surroundings& s,
                     double duration, const Vector6& end) noexcept;

/// Returns the largest of 32 parts of a step up to which a condition holds; 0: up to none.
template <class Condition>
double lastPart(const Condition& holds) {
  double reached = 0, missed = 1;
  while (missed - reached > 1.0 / 32) {
    const double middle = (reached + missed) / 2;
    (holds(middle) ? reached : missed) = middle;
  }
  return reached;
}

/// Notes the wrench that takes a twist `x` in B to `part` of it within a step, for
/// applyAddedMassChanges().
void brakeWithRows(AmbientBody& ambient, const Vector6& x, double part, double duration) noexcept;

/// Plane of the surface in B at the exact pose where the last flight or step with rows ended,
/// before Bullet rounded it; none: the body has met no surface.
std::optional<SurfacePlane> lastPlane(const AmbientBody& ambient) noexcept;

/// Restores the surface of a saved state, and the flotation for lastPlane(). Call
/// between steps.
/// @pre lastPlane() is set; `media` is an index into FluidModels::surfaces
void restoreFloating(AmbientBody& ambient, const RigidState& now, int media) noexcept;

/// A body that Bullet has moved with rows, on its way through the surface.
struct BodyMovedByRows {
  AmbientBody* body = nullptr;
  FrameOffset pose;            ///< B to W, where the step has brought it before Bullet rounded that
  BoundedTwist twist;          ///< in B, relative to the water
  AxisFactors factors;         ///< of the body
  bool keeps_momentum = true;  ///< false: it has locked axes, or the fluid settles it, eq. (124)
  const Vector6* hydrostatics = nullptr;  ///< weight and buoyancy that have acted, in B; null:
                                          ///< those where the step began
};
/// Replaces the twists of up to kFlightsTogether bodies by those after the change of their added
/// mass on the way; without momentum removes only the energy that this change would add. Removes
/// energy above the work of weight and buoyancy, docs/theory.md eq. (68a). The bits of a body do
/// not depend on the others. @pre flotationNow() of the step
void applyAddedMassChanges(BodyMovedByRows* moved, int count, double duration) noexcept;

/// Returns the energy of the water that the body lifts or displaces [J], at a pose B to W that the
/// step may reach a time `duration` [s] after flotationNow(). @pre the body is at a surface
double hydrostaticEnergyAt(const AmbientBody& ambient, const FrameOffset& pose,
                           double duration) noexcept;

/// True if a body that hardly moves may fall asleep where it floats: its balance is not unstable.
bool mayRestAtSurface(AmbientBody& ambient, const MotionView& now) noexcept;

}  // namespace ambient
