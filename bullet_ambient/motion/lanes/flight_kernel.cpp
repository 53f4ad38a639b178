#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/motion/lanes/flow_kernel.h"
#include "bullet_ambient/motion/lanes/motion_lanes.h"
#include "bullet_ambient/motion/lanes/passive_kick_kernel.h"
#include "bullet_ambient/motion/lanes/pose_kernel.h"
#include "bullet_ambient/motion/lanes/push_kernel.h"
#include "bullet_ambient/motion/lanes/row_motion_kernel.h"

// Compiled once per instruction set; AMBIENT_KERNEL() adds its name to that of the kernel. Each
// struct is one kernel of FlightKernel; act() computes the lanes from `at` on.

namespace ambient {
namespace {

struct FlowStep {
  template <class Matrices>
  static void act(FlightLanes& bodies, int at, const Mask& active) {
    flow<Matrices>(bodies, at, active);
  }
};

inline Pairs motionOf(const FlightLanes& bodies, int at) {
  return {load6(bodies.twist_B, at), load6(bodies.momentum_B, at)};
}
inline void setMotion(FlightLanes& bodies, int at, const Mask& active, const Pairs& x) {
  const Pairs now = select(active, x, motionOf(bodies, at));
  store6(bodies.twist_B, at, now.twist);
  store6(bodies.momentum_B, at, now.momentum);
}

struct GravityStep {
  template <class Matrices>
  static void act(FlightLanes& bodies, int at, const Mask& active) {
    const Matrices inverse(bodies.inverse_inertia, at);
    const Orientations q = orientationOf(bodies, at);
    const Spatials wrench = externalWrench(bodies, at, q);
    const Pairs fall = 0.5 * load(bodies.kick_time + at) * Pairs{inverse * wrench, wrench};
    store6(bodies.fall_twist, at, fall.twist);
    store6(bodies.fall_momentum, at, fall.momentum);
    setMotion(bodies, at, active, motionOf(bodies, at) + fall);
    if (!bodies.has_loads) return;
    store6(bodies.guess_B, at, toBody(q, load6(bodies.load_W, at)));
  }
};

struct SampleStep {
  template <class Matrices>
  static void act(FlightLanes& bodies, int at, const Mask&) {
    const Matrices inverse(bodies.inverse_inertia, at);
    const Spatials guess = load6(bodies.guess_B, at);
    const Pairs x = motionOf(bodies, at);
    const Pairs sample =
        passiveKick(x, x, {inverse * guess, guess}, 0.5 * load(bodies.kick_time + at));
    store6(bodies.sample_twist, at, sample.twist);
    store6(bodies.sample_momentum, at, sample.momentum);
  }
};

struct KickStep {
  template <class Matrices>
  static void act(FlightLanes& bodies, int at, const Mask& active) {
    Pairs x = motionOf(bodies, at);
    if (bodies.has_loads) x = underLoads<Matrices>(bodies, at, active, x);
    setMotion(bodies, at, active,
              x + Pairs{load6(bodies.fall_twist, at), load6(bodies.fall_momentum, at)});
  }

 private:
  template <class Matrices>
  static Pairs underLoads(FlightLanes& bodies, int at, const Mask& active, const Pairs& x) {
    const Matrices inverse(bodies.inverse_inertia, at);
    const Lanes duration = load(bodies.kick_time + at);
    const Spatials wrench = load6(bodies.load_B, at);
    const Pairs sample{load6(bodies.sample_twist, at), load6(bodies.sample_momentum, at)};
    const Spatials surprise = wrench - load6(bodies.guess_B, at);
    store(bodies.error + at,
          relativeError(x, {inverse * surprise, surprise}, duration, load(bodies.fall_scale + at)));
    const Spatials load_W = toWorld(orientationOf(bodies, at), wrench);
    store6(bodies.load_W, at, select(active, load_W, load6(bodies.load_W, at)));
    return passiveKick(x, sample, {inverse * wrench, wrench}, duration);
  }

  // Returns the error e of eq. (25). fall_scale avoids tiny substeps where the speed of a swing
  // passes through 0.
  static Lanes relativeError(const Pairs& x, const Pairs& surprise, const Lanes& duration,
                             const Lanes& fall_scale) {
    const Lanes zero = Lanes{};
    const Lanes change = duration * squareRoot(larger(inner(surprise, surprise), zero));
    const Lanes scale = squareRoot(larger(inner(x, x), zero)) + fall_scale;
    return scale > zero ? change / (scale > zero ? scale : all(1)) : zero;
  }
};

// Twice the kinetic energy, and the potential energy of forces that are constant over the step, eq.
// (25a) [J].
struct Energies {
  Lanes kinetic2, potential;
};
inline Energies energies(const FlightLanes& bodies, int at) {
  const Pairs x = motionOf(bodies, at);
  const Vectors buoyancy = load(bodies.buoyancy_W, at);
  const Vectors arm = orientationOf(bodies, at).toWorld(load(bodies.centre_of_volume_B, at));
  const Vectors force = load(bodies.force_W, at) + buoyancy;
  return {inner(x, x), Lanes{} - dot(force, load(bodies.way_W, at)) - dot(buoyancy, arm)};
}

struct MeasureStep {
  template <class>
  static void act(FlightLanes& bodies, int at, const Mask&) {
    const Energies now = energies(bodies, at);
    store(bodies.energy + at, 0.5 * now.kinetic2 + now.potential);
  }
};

struct BoundStep {
  template <class>
  static void act(FlightLanes& bodies, int at, const Mask& active) {
    const Lanes zero = Lanes{};
    const Vectors torque = load(bodies.torque_W, at);
    const Energies now = energies(bodies, at);
    const Lanes allowed = larger(2 * (load(bodies.energy + at) - now.potential), zero);
    const Mask gains = active & (now.kinetic2 > allowed) & (dot(torque, torque) == zero);
    if (!anyOf(gains)) return;
    const Lanes removed = gains ? 0.5 * (now.kinetic2 - allowed) : zero;
    store(bodies.energy_removed + at, load(bodies.energy_removed + at) + removed);
    const Lanes scale = squareRoot(gains ? allowed / now.kinetic2 : all(1));
    setMotion(bodies, at, gains, scale * motionOf(bodies, at));
  }
};

// Runs a step for all active lanes, with diagonal matrices if all bodies have them.
template <class Step>
void forAll(FlightLanes& bodies) noexcept {
  for (int at = 0; at < kFlightLanes; at += kWidth) {
    const Mask active = load(bodies.active + at) > Lanes{};
    if (!anyOf(active)) continue;
    if (bodies.has_diagonal_inertia) {
      Step::template act<DiagonalMatrices>(bodies, at, active);
    } else {
      Step::template act<FullMatrices>(bodies, at, active);
    }
  }
}

// Runs a step of bodies with rows for all lanes with an active body.
template <class Step, class Rows>
void forAllWithRows(Rows& lanes) noexcept {
  for (int at = 0; at < kFlightLanes; at += kWidth) {
    if (!anyOf(load(lanes.bodies.active + at) > Lanes{})) continue;
    if (lanes.bodies.has_diagonal_inertia) {
      Step::template act<DiagonalMatrices>(lanes, at);
    } else {
      Step::template act<FullMatrices>(lanes, at);
    }
  }
}

}  // namespace

const FlightKernel AMBIENT_KERNEL(kFlightKernel){depart,
                                                 arrive,
                                                 forAll<FlowStep>,
                                                 forAll<GravityStep>,
                                                 forAll<SampleStep>,
                                                 forAll<KickStep>,
                                                 forAll<MeasureStep>,
                                                 forAll<BoundStep>,
                                                 forAllWithRows<PushStep>,
                                                 forAllWithRows<KeepStep>,
                                                 forAllWithRows<CarryStep>};

}  // namespace ambient
