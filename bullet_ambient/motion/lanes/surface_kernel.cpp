#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/motion/lanes/body_kernel.h"
#include "bullet_ambient/motion/lanes/floating_kernel.h"
#include "bullet_ambient/motion/lanes/motion_lanes.h"
#include "bullet_ambient/motion/lanes/spatial_lanes.h"
#include "bullet_ambient/motion/lanes/surface_lanes.h"

// Compiled once per instruction set; AMBIENT_KERNEL() adds its name to that of the kernel.

namespace ambient {

namespace {

Modes modesAt(const FlotationLanes& flotation, int at) {
  Modes modes;
  forEachNumber(modes, flotation.modes,
                [&](Lanes& to, const FlightLane& from) { to = load(from + at); });
  return modes;
}

void store(FlightLane (&to)[kSymmetricEntries], int at, const SymmetricOf<Lanes>& m) {
  for (int i = 0; i < kSymmetricEntries; ++i) store(to[i] + at, m.entries[i]);
}

void computeFlotation(FlotationLanes& flotation, int at) {
  const FullMatrices inertia(flotation.inertia, at);
  store(flotation.inverse, at, PositiveFactor<Lanes>(inertia).inverse());
  const Mask is_fine =
      PositiveFactor<Lanes>(inertia - FullMatrices(flotation.least, at)).isPositive();
  store(flotation.is_indefinite + at, is_fine ? Lanes{} : all(1));
  Waterplanes section{load(flotation.area + at), load(flotation.centroid, at), {}};
  for (int i = 0; i < 6; ++i) section.spread[i] = load(flotation.spread[i] + at);
  Modes modes;
  setRestoring(section, load(flotation.moment, at), load(flotation.normal, at),
               load(flotation.specific_weight + at), modes);
  setWaves(flotation, at, modes);
  forEachNumber(flotation.modes, modes,
                [&](FlightLane& to, const Lanes& from) { store(to + at, from); });
  store(flotation.frequency + at, squareRoot(frequencySquared(modes, inertia)));
}

/// Returns the present twists and momenta.
Pairs motionOf(const FlightLanes& bodies, int at) {
  const Spatials x = load6(bodies.twist_B, at);
  return {x, FullMatrices(bodies.inertia, at) * x};
}
void setTwist(FlightLanes& bodies, int at, const Mask& active, const Spatials& x) {
  store6(bodies.twist_B, at, select(active, x, load6(bodies.twist_B, at)));
}
Lanes halfKick(const FlightLanes& bodies, int at) { return 0.5 * load(bodies.kick_time + at); }

void see(SurfaceLanes& bodies, int at, const Mask&) {
  const Vectors normal_W = load(bodies.normal_W, at);
  store(bodies.flotation.normal, at,
        loadOrientation(bodies.flight.orientation, at).toBody(normal_W));
  store(bodies.flotation.height + at,
        load(bodies.height_W + at) - dot(normal_W, load(bodies.flight.displacement_W, at)));
}

void changeInertia(SurfaceLanes& bodies, int at, const Mask& active) {
  FlightLanes& flight = bodies.flight;
  const FullMatrices before(flight.inertia, at), after(bodies.flotation.inertia, at),
      inverse_after(bodies.flotation.inverse, at);
  const AfterChangeOf<Lanes> changed = applyAddedMassChange(
      {before, after, inverse_after, load6(bodies.gradient, at), load(bodies.flotation.normal, at),
       load(bodies.centre_of_buoyancy, at), load(bodies.draught + at),
       load(bodies.submergence + at), load(bodies.flotation.gravity + at),
       load(flight.drift_time + at), load(flight.velocity_scale + at)},
      load6(flight.twist_B, at));
  setTwist(flight, at, active, changed.twist);
  store(bodies.change_error + at, changed.error);
  const Lanes removed = load(flight.energy_removed + at);
  store(flight.energy_removed + at, active ? removed + changed.energy_removed : removed);
  for (int i = 0; i < kSymmetricEntries; ++i) {
    const Lanes old = load(flight.inertia[i] + at),
                old_inverse = load(flight.inverse_inertia[i] + at);
    store(flight.inertia[i] + at, active ? load(bodies.flotation.inertia[i] + at) : old);
    store(flight.inverse_inertia[i] + at,
          active ? load(bodies.flotation.inverse[i] + at) : old_inverse);
  }
}

Spatials wrenchAt(const SurfaceLanes& bodies, int at) {
  const FlightLanes& flight = bodies.flight;
  const FlotationLanes& flotation = bodies.flotation;
  const Spatials dry = externalWrench(flight, at, loadOrientation(flight.orientation, at));
  const Vectors up = load(flotation.specific_weight + at) * load(flotation.normal, at);
  return {dry.angular + cross(load(flotation.moment, at), up),
          dry.linear + load(flotation.volume + at) * up};
}

void kickByGravity(SurfaceLanes& bodies, int at, const Mask& active) {
  FlightLanes& flight = bodies.flight;
  const FullMatrices inertia(flight.inertia, at);
  const Spatials wrench = wrenchAt(bodies, at);
  Spatials change = FullMatrices(flight.inverse_inertia, at) * wrench;
  const Mask is_stiff = active & (load(bodies.is_stiff + at) > Lanes{});
  if (anyOf(is_stiff)) {
    const PositiveFactor<Lanes> stiff(
        stiffened(inertia, modesAt(bodies.flotation, at), load(flight.kick_time + at)));
    change = select(is_stiff, stiff.solve(wrench), change);
  }
  setTwist(flight, at, active, load6(flight.twist_B, at) + halfKick(flight, at) * change);
  store6(flight.momentum_B, at, inertia * load6(flight.twist_B, at));
}

void exchangeWithWaves(SurfaceLanes& bodies, int at, const Mask& active) {
  const Modes of_body = modesAt(bodies.flotation, at);
  const Orientations q = loadOrientation(bodies.flight.orientation, at);
  const ModesAtPose<Lanes> modes{of_body, {q.toWorld(of_body.tilt[0]), q.toWorld(of_body.tilt[1])}};
  WavesOf<Lanes> waves;
  forEachNumber(waves, bodies.waves,
                [&](Lanes& to, const FlightLane& from) { to = load(from + at); });
  projectOnModes(modes, waves);
  const Spatials x =
      exchangeWaves(modes, FullMatrices(bodies.flight.inverse_inertia, at),
                    halfKick(bodies.flight, at), load6(bodies.flight.twist_B, at), waves);
  setTwist(bodies.flight, at, active, x);
  forEachNumber(bodies.waves, waves, [&](FlightLane& to, const Lanes& from) {
    store(to + at, active ? from : load(to + at));
  });
}

void applyLastLoad(SurfaceLanes& bodies, int at, const Mask& active) {
  FlightLanes& flight = bodies.flight;
  growResistance<FullMatrices>(flight, at);
  const Spatials load_B = toBody(loadOrientation(flight.orientation, at), load6(flight.load_W, at));
  const Pairs x = motionOf(flight, at);
  const Pairs response{FullMatrices(flight.inverse_inertia, at) * load_B, load_B};
  const Pairs kicked = passiveKick(x, x, response, halfKick(flight, at));
  setTwist(flight, at, active, underResistance(flight, at, kicked, halfKick(flight, at)).twist);
}

void predictLoad(SurfaceLanes& bodies, int at, const Mask&) {
  FlightLanes& flight = bodies.flight;
  growResistance<FullMatrices>(flight, at);
  store6(flight.predicted_load_B, at,
         toBody(loadOrientation(flight.orientation, at), load6(flight.load_W, at)));
  const Lanes time = halfKick(flight, at);
  const Pairs x = underResistance(flight, at, motionOf(flight, at), time);
  sampleLoad<FullMatrices>(flight, at, x, time, false);
}

void applyLoad(SurfaceLanes& bodies, int at, const Mask& active) {
  FlightLanes& flight = bodies.flight;
  growResistance<FullMatrices>(flight, at);
  const Lanes time = halfKick(flight, at);
  const Pairs x = underResistance(flight, at, motionOf(flight, at), time);
  setTwist(flight, at, active, underLoad<FullMatrices>(flight, at, active, x, time, false).twist);
}

/// Returns the velocity of the water minus that of the fluid above, in B.
Spatials windAt(const SurfaceLanes& bodies, int at) {
  return {zeroVectors(),
          loadOrientation(bodies.flight.orientation, at).toBody(load(bodies.wind_W, at))};
}

void sampleWind(SurfaceLanes& bodies, int at, const Mask&) {
  store6(bodies.flight.sample_twist, at, load6(bodies.flight.twist_B, at) + windAt(bodies, at));
}

void kickByWind(SurfaceLanes& bodies, int at, const Mask& active) {
  FlightLanes& flight = bodies.flight;
  const Spatials seen = load6(flight.sample_twist, at), load_B = load6(flight.load_B, at);
  const Pairs x{seen, FullMatrices(flight.inertia, at) * seen};
  const Pairs response{FullMatrices(flight.inverse_inertia, at) * load_B, load_B};
  const Spatials end = passiveKick(x, x, response, halfKick(flight, at)).twist;
  setTwist(flight, at, active, end - windAt(bodies, at));
}

void measure(SurfaceLanes& bodies, int at, const Mask&) {
  const FlightLanes& flight = bodies.flight;
  const Pairs x = motionOf(flight, at);
  const Vectors buoyancy = load(flight.buoyancy_W, at);
  const Vectors displacement = load(flight.displacement_W, at);
  const Vectors arm =
      displacement +
      loadOrientation(flight.orientation, at).toWorld(load(flight.centre_of_volume_B, at));
  const Lanes of_water =
      load(bodies.flotation.specific_weight + at) * load(bodies.flotation.depth_integral + at) +
      load(bodies.waves.heave_energy + at) + load(bodies.waves.tilt_energy + at) +
      load(bodies.slosh_energy + at);
  store(bodies.kinetic2 + at, inner(x, x));
  store(bodies.potential + at,
        of_water - dot(load(flight.force_W, at), displacement) - dot(buoyancy, arm));
}

/// Calls a step for all registers with an active body, which begin with the lane `at`.
template <void (*kStep)(SurfaceLanes& bodies, int at, const Mask& active)>
void forAll(SurfaceLanes& bodies) noexcept {
  for (int at = 0; at < kFlightLanes; at += kWidth) {
    const Mask active = load(bodies.flight.active + at) > Lanes{};
    if (anyOf(active)) kStep(bodies, at, active);
  }
}

void computeFlotations(FlotationLanes& flotation) noexcept {
  for (int at = 0; at < kFlightLanes; at += kWidth)
    if (anyOf(load(flotation.active + at) > Lanes{})) computeFlotation(flotation, at);
}

}  // namespace

const SurfaceKernel AMBIENT_KERNEL(kSurfaceKernel){
    computeFlotations,         forAll<see>,           forAll<changeInertia>, forAll<kickByGravity>,
    forAll<exchangeWithWaves>, forAll<applyLastLoad>, forAll<predictLoad>,   forAll<applyLoad>,
    forAll<sampleWind>,        forAll<kickByWind>,    forAll<measure>};

}  // namespace ambient
