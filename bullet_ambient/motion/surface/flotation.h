#pragma once

#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/lanes/surface_lanes.h"
#include "bullet_ambient/motion/surface/surface_model.h"
#include "bullet_ambient/spatial/spatial_vectors.h"

namespace ambient {

/// Position of a body relative to the water surface at one pose; in B, unless the name says
/// otherwise.
struct SurfacePlace {
  SurfacePlane plane;
  Immersion immersion_F;    ///< of the closed vessel
  SymmetricMatrix inertia;  ///< K of body, fluids and water inside, docs/theory.md eq. (63)
  const WaterInside* inside_F = nullptr;  ///< in its holds; null: none
};

/// Computes the place for a plane in B, whose density and gravity count.
SurfacePlace placeAt(const SurfaceModel& model, const SurfacePlane& plane_B,
                     const VesselWater& water = {}) noexcept;

/// A body with water in its holds at a place. @pre inside_F of the place, with its modes
struct WaterAt {
  const SurfaceModel& model;
  const SurfacePlace& place;
  Matrix3 to_world;    ///< B to W
  Vector3 position_W;  ///< of the centre of mass, in a frame that moves with the water [m]

  SloshingAt sloshing() const {
    return {model.excess_density, place.inside_F->modes, model.holds->shapes.size(), to_world};
  }
};
/// Water in the holds at a place that the body has left: its part of K, in B, and its sloshing.
struct WaterLeft {
  WaterLeft() = default;
  WaterLeft(const WaterAt& at, const Sloshing* states, double sloshing_energy) noexcept;

  SymmetricMatrix inertia;
  Momentum momentum_W;
  double energy = 0;  ///< [J]
  Vector3 position_W{0, 0, 0};
};
/// Takes the sloshing to the modes of another place, to which the water has moved with its body,
/// and adds the change by the water to an inertia K; docs/theory.md eq. (142), (154). Returns the
/// twist thereafter for the twist x before: the momentum of body and water stays but for a torque
/// along the tilt, by which the energy does, too, and it never grows. A K that would not be
/// positive definite stays as it is, with the twist.
Vector6 shiftWater(const WaterLeft& before, const WaterAt& after, const Vector6& x,
                   SymmetricMatrix& inertia, Sloshing* states) noexcept;

/// A place, and quantities that follow from it: inverse inertia, stiffness, waves.
struct Flotation : SurfacePlace {
  SymmetricMatrix inverse;  ///< K^-1
  FloatingModes modes{};
  double frequency = 0;  ///< largest natural frequency of the body on its buoyancy [1/s]
};

/// Computes the fields of up to kFlightsTogether Flotations that follow from their
/// SurfacePlaces, side by side. The bits of a flotation do not depend on the others.
void completeFlotations(const SurfaceModel* const* models, Flotation* const* flotations,
                        int count) noexcept;
/// Computes the flotation of a body for a plane in B, whose density and gravity count. Cost: 1 us
/// for a hull of some hundred triangles.
Flotation flotationAt(const SurfaceModel& model, const SurfacePlane& plane_B,
                      const VesselWater& water = {}) noexcept;

/// Returns the wet volume of the closed vessel in B.
inline WetVolume wetOutside(const SurfaceModel& model, const SurfacePlace& place) noexcept {
  const WetVolume& wet_F = place.immersion_F.wet;
  return model.fluid_frame.isIdentity() ? wet_F : wet_F.inB(model.fluid_frame);
}
/// Returns the same less the water in the holds, docs/theory.md eq. (135).
inline WetVolume wetVolume(const SurfaceModel& model, const SurfacePlace& place) noexcept {
  if (!place.inside_F) return wetOutside(model, place);
  return place.inside_F->with(place.immersion_F.wet).inB(model.fluid_frame);
}

/// Returns the energy of the buoyancy at a plane in B less that at a place that is near, where
/// Bullet has not yet rounded the pose, docs/theory.md eq. (53a) [J].
inline double energyOfRounding(const SurfaceModel& model, const SurfacePlace& place,
                               const SurfacePlane& plane_B) noexcept {
  const Immersion& at = place.immersion_F;
  const SurfacePlane near = seenFrom(plane_B, model.fluid_frame);
  if (!place.inside_F) return hydrostaticEnergyChange(at.wet, at.plane, near);
  WetVolume wet = place.inside_F->with(at.wet);
  wet.waterplane.spread -= place.inside_F->spread;
  return hydrostaticEnergyChange(wet, at.plane, near);
}

/// True if no small displacement grows, up and down or about an axis of the waterplane. A balance
/// is neutral, and does not count as growth, if the stiffness of a tilt is within half a per cent
/// of the waterplane's part of it. Counts what the levels in the holds take off, docs/theory.md eq.
/// (137).
bool isStable(const SurfaceModel& model, const Flotation& flotation) noexcept;

/// Longest step that needs no stiffInertia(), times the largest natural frequency [1].
constexpr double kLongestPhase = 0.5;

/// Returns K stiffened() by `modes` for a long step of `duration` [s], so that the step does not
/// overshoot the balance of buoyancy; implicit trapezoidal rule.
Matrix6 stiffInertia(const Flotation& flotation, const FloatingModes& modes,
                     double duration) noexcept;

/// Returns the modes with the stiffness of the waterplane alone, rho g A_w and rho g I_i: what
/// buoyancy lacks if the volume that is wet now turns with the body. Never negative.
FloatingModes modesOfWaterplane(const Flotation& flotation) noexcept;

/// Returns a model with constant inertia and displacement, for a step in which constraint rows move
/// the body. The caller adds the loads, in the frame of SurfaceModel::loads_below.
BodyModel frozenAt(const SurfaceModel& model, const Flotation& flotation) noexcept;

/// Sets mass and centre of what a frozen model displaces; `wet`: in B.
void displace(const SurfaceModel& model, const WetVolume& wet, BodyModel& frozen) noexcept;

/// Computes F_K of docs/theory.md eq. (66) for a twist x in B relative to the water.
Wrench gradientAt(const SurfaceModel& model, const SurfacePlace& place, const Twist& x) noexcept;

/// Returns the centre of the wet volume of the closed vessel in B [m]; of a dry body, the centre of
/// its volume.
Vector3 centreOfBuoyancy(const SurfaceModel& model, const SurfacePlace& place) noexcept;

/// Depths of a body's lowest and highest point on a way, the means of those at its two ends [m]. A
/// point in the air counts as at the surface.
struct MeanDepths {
  double draught, submergence;
};
MeanDepths meanDepths(const Immersion& before, const Immersion& after) noexcept;

/// Computes x_1 of docs/theory.md eq. (66) to (68) of a body that has moved between two poses near
/// the surface. x: twist in B that it would have at the second pose with the inertia K_0 of the
/// first. F_K is that of the second pose, or of the first if the body has left the water.
BoundedTwist applyAddedMassChange(const SurfaceModel& model, const SurfacePlace& before,
                                  const Flotation& after, double duration,
                                  const Vector6& x) noexcept;

/// Load on the part of a body in the fluid below, in B, for a twist in B relative to that fluid; as
/// computeSurfaceLoad().
SurfaceLoad loadBelow(const SurfaceModel& model, const SurfacePlace& place, const Twist& x,
                      double load_scale, const FlowAlongBody* flow) noexcept;
/// Part of loadBelow() that is friction, at one station and in full.
Wrench frictionBelow(const SurfaceModel& model, const SurfacePlace& place, const Twist& x) noexcept;
/// Load of the fluid above.
Wrench loadAbove(const SurfaceModel& model, const SurfacePlace& place, const Twist& x) noexcept;

/// Computes the twist after the fluid above has acted on the dry part of a body for a duration [s],
/// by docs/theory.md eq. (23) in the frame of that fluid. Twists in B, relative to the water;
/// `wind`: velocity of the water minus that of the fluid above, in B [m/s]. Cost: one evaluation of
/// the loads. @pre the model has loads_above.loads
Vector6 kickByWind(const SurfaceModel& model, const Flotation& flotation, const Vector3& wind,
                   double duration, const Vector6& x) noexcept;

/// Lets the waves that a body has made and the body act on each other for `duration` [s]. First
/// converts `waves` to the present modes, which never adds energy; eq. (72). Then integrates eq.
/// (71): the sum of x.K x / 2 and the energy of the waves does not grow, whatever the duration. x:
/// twist in B; `to_world`: B to W; `inverse_inertia`: K^-1. @return the twist afterwards; `waves`
/// is updated
Vector6 exchangeWaves(const FloatingModes& modes, const Matrix3& to_world,
                      const SymmetricMatrix& inverse_inertia, double duration, const Vector6& x,
                      WaveMemory& waves) noexcept;

/// Returns the mean wrench of the waves on the body, in B, while their states change evenly from
/// `before` to `after`; eq. (70).
Wrench waveWrench(const FloatingModes& modes, const Matrix3& to_world, const WaveMemory& before,
                  const WaveMemory& after) noexcept;

// Lanes of several bodies.

extern const Kernels<const SurfaceKernel*> kSurfaceKernels;

inline void setLane(FlightLane (&to)[kSymmetricEntries], int body,
                    const SymmetricMatrix& m) noexcept {
  for (int entry = 0; entry < kSymmetricEntries; ++entry) to[entry][body] = m.entries[entry];
}

/// Reads lane `body`.
inline SymmetricMatrix symmetricOf(const FlightLane (&from)[kSymmetricEntries], int body) noexcept {
  SymmetricMatrix m;
  for (int entry = 0; entry < kSymmetricEntries; ++entry) m.entries[entry] = from[entry][body];
  return m;
}

/// Writes a place into lane `body`, as input of computeFlotations().
void setPlace(FlotationLanes& lanes, int body, const SurfaceModel& model,
              const SurfacePlace& place) noexcept;
/// Writes into lane `body` the fields of a flotation that a flight reads.
void setFlotation(FlotationLanes& lanes, int body, const SurfaceModel& model,
                  const Flotation& flotation) noexcept;
/// Copies the result of computeFlotations() from lane `body` to a flotation.
void readFlotation(const FlotationLanes& lanes, int body, Flotation& flotation) noexcept;

/// Calls SurfaceKernel::computeFlotations() for the active lanes. Replaces a K that is not positive
/// definite by positiveInertia(), in the place of the body, too.
void computeFlotations(FlotationLanes& lanes, const SurfaceModel* const* models,
                       SurfacePlace* const* places, int count) noexcept;

}  // namespace ambient
