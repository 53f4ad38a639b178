#include "bullet_ambient/motion/surface/flotation.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/ambient_assert.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/motion/body/one_body.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/lanes/body_kernel.h"
#include "bullet_ambient/motion/lanes/floating_kernel.h"
#include "bullet_ambient/spatial/inertia.h"

namespace ambient {
SurfacePlace placeAt(const SurfaceModel& model, const SurfacePlane& plane_B,
                     const VesselWater& water) noexcept {
  SurfacePlace place;
  place.plane = plane_B;
  place.immersion_F = immersionOf(model, plane_B);
  place.inertia = SymmetricMatrix(inertiaAt(model, place.immersion_F));
  if (!water.states) return place;
  *water.inside = waterInside(*model.holds, water.states, place.immersion_F.plane,
                              model.fluid_frame, model.excess_density, water.modes);
  if (!water.inside->is_any) return place;
  place.inside_F = water.inside;
  for (int i = 0; i < kSymmetricEntries; ++i)
    place.inertia.entries[i] += water.inside->inertia.entries[i];
  return place;
}

WaterLeft::WaterLeft(const WaterAt& at, const Sloshing* states, double sloshing_energy) noexcept
    : inertia(at.place.inside_F->inertia),
      momentum_W(momentumOfSloshing(at.sloshing(), states)),
      energy(sloshing_energy),
      position_W(at.position_W) {}

Vector6 shiftWater(const WaterLeft& before, const WaterAt& after, const Vector6& x,
                   SymmetricMatrix& inertia, Sloshing* states) noexcept {
  using Spatial = SpatialsOf<double>;
  SymmetricMatrix changed = inertia;
  for (int i = 0; i < kSymmetricEntries; ++i)
    changed.entries[i] += after.place.inside_F->inertia.entries[i] - before.inertia.entries[i];
  const SloshingAt at = after.sloshing();
  const double given2 = 2 * (before.energy - projectOnModes(at, before.energy, states));
  // The momentum before, about the centre of mass after it, less that after.
  const Momentum now_W = momentumOfSloshing(at, states);
  const Momentum& then_W = before.momentum_W;
  const Vector3 displacement_W = after.position_W - before.position_W;
  const Matrix3 to_body = after.to_world.transpose();
  const Spatial given{
      plain(Vector3(to_body *
                    (then_W.angular - displacement_W.cross(then_W.linear) - now_W.angular))),
      plain(Vector3(to_body * (then_W.linear - now_W.linear)))};
  const PositiveFactor<double> factor(changed);
  if (!factor.isPositive()) return x;
  const Spatial start = plain(x), own = inertia * start, momentum = own + given;
  const double allowed2 = dot(start, own) + given2;
  const Spatial free = factor.solve(momentum);
  // A torque along the tilt: the part of the spin across the normal.
  const VectorsOf<double> normal = plain(after.place.plane.normal),
                          tilt = free.angular - dot(normal, free.angular) * normal;
  const Spatial response = factor.solve({tilt, {0, 0, 0}});
  const double a = dot(response.angular, tilt), b = dot(tilt, tilt);
  const double excess = dot(free, momentum) - allowed2, square = b * b - a * excess;
  const bool turns = a > 0 && square > 0;
  const Spatial end = free - (turns ? excess / (b + std::sqrt(square)) : 0.0) * response;
  inertia = changed;
  return asEigen(scaleWithin(dot(end, changed * end), larger(allowed2, 0.0)) * end);
}

bool isStable(const SurfaceModel& model, const Flotation& flotation) noexcept {
  constexpr double kNeutral = 0.005;  // the flat sides of a barrel's mesh make 0.0022
  const double specific_weight = flotation.plane.density * flotation.plane.gravity;
  const FloatingModes& modes = flotation.modes;
  const auto isTiltStable = [&](int i) {
    double stiffness = modes.stiffness[i + 1], of_plane = specific_weight * modes.second_moment[i];
    if (flotation.inside_F) {
      const Vector3 across_F = model.fluid_frame.rotation.transpose() *
                               flotation.plane.normal.cross(asEigen(modes.tilt[i]));
      const double of_levels =
          specific_weight * across_F.dot(flotation.inside_F->spread * across_F);
      stiffness -= of_levels;
      of_plane = std::max(0.0, of_plane - of_levels);
    }
    return stiffness >= -kNeutral * of_plane;
  };
  return modes.stiffness[0] >= 0 && isTiltStable(0) && isTiltStable(1);
}

Matrix6 stiffInertia(const Flotation& flotation, const FloatingModes& modes,
                     double duration) noexcept {
  AMBIENT_ASSERT(duration >= 0);
  return SymmetricMatrix(stiffened(flotation.inertia, modes, duration)).full();
}

FloatingModes modesOfWaterplane(const Flotation& flotation) noexcept {
  FloatingModes modes = flotation.modes;
  for (int i = 0; i < 2; ++i)
    modes.stiffness[i + 1] =
        flotation.plane.density * flotation.plane.gravity * modes.second_moment[i];
  return modes;
}

BodyModel frozenAt(const SurfaceModel& model, const Flotation& flotation) noexcept {
  BodyModel frozen = model.above;
  frozen.inertia = flotation.inertia.full();
  frozen.inverse_inertia = flotation.inverse.full();
  frozen.has_diagonal_inertia = false;
  frozen.loads = nullptr;
  displace(model, wetVolume(model, flotation), frozen);
  return frozen;
}

void displace(const SurfaceModel& model, const WetVolume& wet, BodyModel& frozen) noexcept {
  const double water = model.excess_density * wet.volume;
  frozen.displaced_mass = model.above.displaced_mass + water;
  if (frozen.displaced_mass != 0) {
    frozen.centre_of_volume = (model.above.displaced_mass * model.above.centre_of_volume +
                               model.excess_density * wet.moment) /
                              frozen.displaced_mass;
  }
}

Wrench gradientAt(const SurfaceModel& model, const SurfacePlace& place, const Twist& x) noexcept {
  const FrameOffset& frame = model.fluid_frame;
  const Immersion& at = place.immersion_F;
  if (frame.isIdentity())
    return model.added_density * model.wetted->gradient(at, x).wrench(at.plane);
  return model.added_density * frame.toB(model.wetted->gradient(at, frame.toF(x)).wrench(at.plane));
}

namespace {

/// Moment of a wet volume in B, as WetVolume::inB() has it.
Vector3 momentInB(const WetVolume& wet_F, const FrameOffset& frame) {
  return frame.rotation * wet_F.moment + wet_F.volume * frame.translation;
}

}  // namespace

Vector3 centreOfBuoyancy(const SurfaceModel& model, const SurfacePlace& place) noexcept {
  const WetVolume& wet_F = place.immersion_F.wet;
  if (!(wet_F.volume > 0)) return model.above.centre_of_volume;
  return momentInB(wet_F, model.fluid_frame) / wet_F.volume;
}

MeanDepths meanDepths(const Immersion& before, const Immersion& after) noexcept {
  const auto mean = [](double a, double b) { return (std::max(0.0, a) + std::max(0.0, b)) / 2; };
  return {mean(before.draught(), after.draught()), mean(before.submergence(), after.submergence())};
}

BoundedTwist applyAddedMassChange(const SurfaceModel& model, const SurfacePlace& before,
                                  const Flotation& after, double duration,
                                  const Vector6& x) noexcept {
  const Immersion& at = after.immersion_F;
  const SurfacePlace& wet = at.isDry() ? before : after;
  const Wrench gradient = gradientAt(model, wet, Twist::fromVector(x));
  const MeanDepths depths = meanDepths(before.immersion_F, at);
  AMBIENT_ASSERT(duration > 0 && !(after.plane.gravity < 0) && isUnit(after.plane.normal));
  const AfterChangeOf<double> changed =
      applyAddedMassChange({before.inertia, after.inertia, after.inverse, plain(gradient.vector()),
                            plain(after.plane.normal), plain(centreOfBuoyancy(model, after)),
                            depths.draught, depths.submergence, after.plane.gravity, duration},
                           plain(x));
  return {asEigen(changed.twist), changed.energy_removed};
}

SurfaceLoad loadBelow(const SurfaceModel& model, const SurfacePlace& place, const Twist& x,
                      double load_scale, const FlowAlongBody* flow) noexcept {
  const double wet = wetShare(place.immersion_F, model.shape->volume);
  const PartLoads& below = model.loads_below;
  AMBIENT_ASSERT(below.loads);
  const WetPart part{seenFrom(place.plane, below.frame), wet};
  return loadAlong(flow, x, below.resistance.get(), [&](const Twist& at_station) -> SurfaceLoad {
    const SplitLoad split = below.loads->split(below.frame.toF(at_station), &part);
    const Wrench wrench = load_scale * below.frame.toB(split.wrench);
    SurfaceLoad load{wrench};
    if (below.loads->needsGuard())
      load = removePositivePower(wrench, at_station, place.inertia.full());
    load.growth = split.growth;
    return load;
  });
}

Wrench frictionBelow(const SurfaceModel& model, const SurfacePlace& place,
                     const Twist& x) noexcept {
  const PartLoads& part = model.loads_below;
  const WetPart wet{seenFrom(place.plane, part.frame),
                    wetShare(place.immersion_F, model.shape->volume)};
  return part.frame.toB(part.loads->wetParts(part.frame.toF(x), wet).friction);
}

Wrench loadAbove(const SurfaceModel& model, const SurfacePlace& place, const Twist& x) noexcept {
  const double share = 1 - wetShare(place.immersion_F, model.shape->volume);
  const PartLoads& above = model.loads_above;
  AMBIENT_ASSERT(above.loads);
  const WetPart dry{seenFrom(place.plane.flipped(), above.frame), share};
  return model.load_factor * above.frame.toB(above.loads->wetLoad(above.frame.toF(x), dry));
}

Vector6 kickByWind(const SurfaceModel& model, const Flotation& flotation, const Vector3& wind,
                   double duration, const Vector6& x) noexcept {
  const Vector6 shift = stack(Vector3::Zero(), wind);
  const Vector6 seen = x + shift;
  AMBIENT_ASSERT(duration >= 0);
  const Vector6 load = loadAbove(model, flotation, Twist::fromVector(seen)).vector();
  const PairsOf<double> motion = plain(DualPair{seen, flotation.inertia.full() * seen});
  const PairsOf<double> response = plain(DualPair{flotation.inverse.full() * load, load});
  return asEigen(passiveKick(motion, motion, response, duration).twist) - shift;
}

Vector6 exchangeWaves(const FloatingModes& modes, const Matrix3& to_world,
                      const SymmetricMatrix& inverse_inertia, double duration, const Vector6& x,
                      WaveMemory& waves) noexcept {
  AMBIENT_ASSERT(duration >= 0 && !(waves.heave_energy < 0) && !(waves.tilt_energy < 0));
  const auto tilt_W = [&](int i) { return plain(Vector3(to_world * asEigen(modes.tilt[i]))); };
  const ModesAtPose<double> at_pose{modes, {tilt_W(0), tilt_W(1)}};
  projectOnModes(at_pose, waves);
  return asEigen(exchangeWaves(at_pose, inverse_inertia, duration, plain(x), waves));
}

Wrench waveWrench(const FloatingModes& modes, const Matrix3& to_world, const WaveMemory& before,
                  const WaveMemory& after) noexcept {
  const double heave = (before.heave.first + after.heave.first) / 2;
  Wrench wrench = Wrench::fromVector(-modes.strength[0] * heave * asEigen(modes.heave));
  const Vector3 tilt_B = to_world.transpose() * asEigen(before.tilt_W[0] + after.tilt_W[0]) / 2;
  for (int i = 0; i < 2; ++i) {
    const Vector3 axis = asEigen(modes.tilt[i]);
    wrench.torque -= modes.strength[i + 1] * axis.dot(tilt_B) * axis;
  }
  return wrench;
}

namespace {

constexpr int kSpread[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

void setPlane(FlotationLanes& lanes, int body, const SurfacePlane& plane) {
  setLane(lanes.normal, body, plane.normal);
  lanes.height[body] = plane.height;
  lanes.gravity[body] = plane.gravity;
  lanes.specific_weight[body] = plane.density * plane.gravity;
}

/// `moment`: in B.
void setWetVolume(FlotationLanes& lanes, int body, const WetVolume& wet, const Vector3& moment) {
  lanes.volume[body] = wet.volume;
  lanes.depth_integral[body] = wet.depth_integral;
  setLane(lanes.moment, body, moment);
}

/// Added mass along the normal per unit density, without its factor, times c of docs/theory.md
/// eq. (69) [m^3].
double heaveInertia(const SurfaceModel& model, const SurfacePlace& place) {
  if (!(model.excess_density > 0)) return 0;
  const Vector3& s = place.plane.normal;
  const Matrix3 fluid = place.inertia.bottomRight() - model.above.inertia.bottomRightCorner<3, 3>();
  const double heave = model.heave_factor / model.added_density * s.dot(fluid * s);
  // The volume outside counts, and the factors are those of the added mass alone.
  const double inside = place.inside_F ? -place.inside_F->below.volume : 0;
  const double factors = model.heave_factor * (model.excess_density / model.added_density);
  return std::max(0.0, inside > 0 ? heave + (1 - factors) * inside : heave);
}

}  // namespace

void setPlace(FlotationLanes& lanes, int body, const SurfaceModel& model,
              const SurfacePlace& place) noexcept {
  setPlane(lanes, body, place.plane);
  const WetVolume wet = wetVolume(model, place);
  setWetVolume(lanes, body, wet, wet.moment);
  const Waterplane& section = wet.waterplane;
  lanes.area[body] = section.area;
  setLane(lanes.centroid, body, section.centroid);
  for (int i = 0; i < 6; ++i) lanes.spread[i][body] = section.spread(kSpread[i][0], kSpread[i][1]);
  lanes.heave_inertia[body] = heaveInertia(model, place);
  lanes.damping[body] = model.wave_damping;
  setLane(lanes.inertia, body, place.inertia);
  setLane(lanes.least, body, SymmetricMatrix(kLeastShare * model.above.inertia));
}

void setFlotation(FlotationLanes& lanes, int body, const SurfaceModel& model,
                  const Flotation& flotation) noexcept {
  setPlane(lanes, body, flotation.plane);
  const WetVolume& vessel_F = flotation.immersion_F.wet;
  const WetVolume wet_F = flotation.inside_F ? flotation.inside_F->with(vessel_F) : vessel_F;
  setWetVolume(lanes, body, wet_F, momentInB(wet_F, model.fluid_frame));
  forEachNumber(lanes.modes, flotation.modes,
                [&](FlightLane& to, const double& from) { to[body] = from; });
}

void readFlotation(const FlotationLanes& lanes, int body, Flotation& flotation) noexcept {
  flotation.inverse = symmetricOf(lanes.inverse, body);
  forEachNumber(flotation.modes, lanes.modes,
                [&](double& to, const FlightLane& from) { to = from[body]; });
  flotation.frequency = lanes.frequency[body];
}

void computeFlotations(FlotationLanes& lanes, const SurfaceModel* const* models,
                       SurfacePlace* const* places, int count) noexcept {
  kSurfaceKernels.fastest()->computeFlotations(lanes);
  const auto isIndefinite = [&](int i) {
    return lanes.active[i] > 0 && lanes.is_indefinite[i] > 0;
  };
  bool is_any = false;
  for (int i = 0; i < count; ++i) {
    if (!isIndefinite(i)) continue;
    is_any = true;
    SymmetricMatrix& inertia = places[i]->inertia;
    inertia = SymmetricMatrix(positiveInertia(*models[i], inertia.full()));
    setPlace(lanes, i, *models[i], *places[i]);
    setLane(lanes.least, i, SymmetricMatrix(Matrix6::Zero()));
  }
  if (!is_any) return;
  kSurfaceKernels.fastest()->computeFlotations(lanes);
  for (int i = 0; i < count; ++i)
    if (isIndefinite(i))
      setLane(lanes.inverse, i, SymmetricMatrix(models[i]->above.inverse_inertia));
}

void completeFlotations(const SurfaceModel* const* models, Flotation* const* flotations,
                        int count) noexcept {
  AMBIENT_ASSERT(count >= 0 && count <= kFlightLanes);
  FlotationLanes lanes{};
  SurfacePlace* places[kFlightLanes] = {};
  for (int i = 0; i < count; ++i) {
    lanes.active[i] = 1;
    setPlace(lanes, i, *models[i], *flotations[i]);
    places[i] = flotations[i];
  }
  computeFlotations(lanes, models, places, count);
  for (int i = 0; i < count; ++i) {
    readFlotation(lanes, i, *flotations[i]);
  }
}

Flotation flotationAt(const SurfaceModel& model, const SurfacePlane& plane_B,
                      const VesselWater& water) noexcept {
  Flotation flotation;
  static_cast<SurfacePlace&>(flotation) = placeAt(model, plane_B, water);
  const SurfaceModel* const models = &model;
  Flotation* const flotations = &flotation;
  completeFlotations(&models, &flotations, 1);
  return flotation;
}

}  // namespace ambient
