#include <math.h>

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/base/instruction_set.h"
#include "bullet_ambient/motion/lanes/body_kernel.h"
#include "bullet_ambient/motion/lanes/drift_kernel.h"
#include "bullet_ambient/motion/lanes/flight_lanes.h"
#include "bullet_ambient/motion/lanes/motion_lanes.h"
#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// Compiled once per instruction set; AMBIENT_KERNEL() adds its name to that of the kernel.

namespace ambient {

namespace {

/// Returns the unit quaternions of rotation matrices that are orthogonal up to rounding. Sums of
/// entries give four multiples of the quaternion; the one with the largest scale is normalised
/// (Shepperd 1978).
inline Orientations orientationsOf(const Vectors (&rows)[3]) {
  const Lanes &xx = rows[0].x, &yy = rows[1].y, &zz = rows[2].z;
  const Vectors turn{rows[2].y - rows[1].z, rows[0].z - rows[2].x, rows[1].x - rows[0].y};
  const Vectors mixed{rows[1].z + rows[2].y, rows[2].x + rows[0].z, rows[0].y + rows[1].x};
  const Lanes w = 1 + xx + yy + zz, x = 1 + xx - yy - zz, y = 1 - xx + yy - zz,
              z = 1 - xx - yy + zz;
  Orientations q{turn, w};
  Lanes largest = w;
  const auto prefer = [&](const Lanes& size, const Orientations& other) {
    q = select(size > largest, other, q);
    largest = larger(size, largest);
  };
  prefer(x, {{x, mixed.z, mixed.y}, turn.x});
  prefer(y, {{mixed.z, y, mixed.x}, turn.y});
  prefer(z, {{mixed.y, mixed.x, z}, turn.z});
  return normalized(q);
}

/// Returns the rotation vectors of unit quaternions [rad], of length <= pi. Relative errors are
/// rounding errors for tiny angles, too.
inline Vectors rotationVectors(const Orientations& q) {
  // Series of asin(s) / s in s^2; the first term left out is below rounding.
  constexpr double kSmall = 0.03;
  static constexpr double kSeries[] = {
      1.0,         1.0 / 6,       3.0 / 40,      5.0 / 112,       35.0 / 1152,
      63.0 / 2816, 231.0 / 13312, 143.0 / 10240, 6435.0 / 557056, 12155.0 / 1245184};
  const Lanes sine_sq = dot(q.u, q.u);
  Lanes ratio = polynomial(kSeries, sine_sq);  // half the angle over the sine of half the angle
  if (anyOf(!(sine_sq <= all(kSmall)))) {
    for (int i = 0; i < kWidth; ++i) {
      if (sine_sq[i] <= kSmall) continue;
      const double sine = ::sqrt(sine_sq[i]);
      ratio[i] = portable::atan2(sine, ::fabs(q.w[i])) / sine;
    }
  }
  return (q.w < Lanes{} ? -2 * ratio : 2 * ratio) * q.u;
}

/// Implements FlightKernel::readStarts.
inline void readStarts(StartLanes& bodies) noexcept {
  for (int at = 0; at < kFlightLanes; at += kWidth) {
    const Vectors rows[3] = {load(bodies.rotation, at), load(bodies.rotation + 3, at),
                             load(bodies.rotation + 6, at)};
    const Orientations q = orientationsOf(rows);
    const Spatials twist_W = load6(bodies.twist_W, at);
    storeOrientation(bodies.orientation, at, q);
    store6(bodies.twist_B, at, toBody(q, twist_W));
  }
}

/// Sets numbers smaller in size than `least` to 0; NaN and infinity stay.
inline Lanes withoutTraces(const Lanes& a, const Lanes& least) {
  return larger(a, -a) < least ? Lanes{} : a;
}
inline Vectors withoutTraces(const Vectors& a, const Lanes& least) {
  return {withoutTraces(a.x, least), withoutTraces(a.y, least), withoutTraces(a.z, least)};
}
inline Spatials withoutTraces(const Spatials& a, const Lanes& least) {
  return {withoutTraces(a.angular, least), withoutTraces(a.linear, least)};
}

/// Implements FlightKernel::findEnds.
inline void findEnds(EndLanes& bodies) noexcept {
  const Lanes inverse_duration = all(1 / bodies.duration), least = all(bodies.least);
  for (int at = 0; at < kFlightLanes; at += kWidth) {
    const Orientations q = loadOrientation(bodies.orientation, at);
    const Spatials twist_B = load6(bodies.twist_B, at);
    const Spatials twist_W = toWorld(q, twist_B);
    store6(bodies.twist_W, at, withoutTraces(twist_W, least));
    const Orientations start_inverse{zeroVectors() - load(bodies.start_orientation, at),
                                     load(bodies.start_orientation[3] + at)};
    const Vectors turn = rotationVectors(normalized(q * start_inverse));
    const Vectors displacement = load(bodies.position, at) - load(bodies.start_position, at);
    const Spatials mean_W{inverse_duration * turn, inverse_duration * displacement};
    store6(bodies.mean_W, at, withoutTraces(mean_W, least));
  }
}

/// Sets vectors to zero that are only the rounding of others, as IsotropicResponse::beyond() does.
inline Vectors withoutRounding(const Vectors& a, const Vectors& of) {
  constexpr double kRounding = 1e-12;
  const Mask is_rounding = dot(a, a) <= kRounding * kRounding * dot(of, of);
  return select(is_rounding, zeroVectors(), a);
}

/// Returns k' - k of docs/theory.md eq. (28b): the response with isotropic added mass to a momentum
/// K k, minus k.
inline Spatials isotropicExcess(const RowLanes& push, int at, const Pairs& kick) {
  const Vectors& m = kick.momentum.angular;
  Lanes spin[3];
  for (int i = 0; i < 3; ++i) {
    const FlightLane* row = push.isotropic_inverse_inertia[i];
    spin[i] = load(row[0] + at) * m.x + load(row[1] + at) * m.y + load(row[2] + at) * m.z;
  }
  const Spatials even{{spin[0], spin[1], spin[2]},
                      load(push.isotropic_inverse_mass + at) * kick.momentum.linear};
  const Spatials excess = even - kick.twist;
  return {withoutRounding(excess.angular, even.angular),
          withoutRounding(excess.linear, even.linear)};
}

// Replaces the kick of bodies that the fluid settles in the step, and its momentum, by those of
// eq. (124), which have the turn in them.
template <class Matrices>
void settleInStep(RowLanes& bodies, int at, const Pairs& x, const Spatials& wrench, Spatials& kick,
                  Spatials& push, TurningsOf<Lanes>& turning) {
  const Matrices inertia(bodies.inertia, at), inverse(bodies.inverse_inertia, at);
  const Spatials of_turn = turningWrench(inertia, x);
  const Mask settles = settledOf<Matrices>(bodies, at, x, of_turn);
  store(bodies.settling + at, settles ? load(bodies.settling + at) : Lanes{});
  const Lanes duration = load(bodies.kick_time + at);
  const Spatials load_B = load6(bodies.load_B, at);
  const Spatials met = wrench + of_turn;
  const Pairs settled = withResistance<Matrices>(bodies, at, [&](const auto& terms) {
    return settledKick<Lanes>(x, {inverse * load_B, load_B}, met, terms, duration);
  });
  kick = select(settles, settled.twist - x.twist, kick);
  push = select(settles, duration * met, push);
  turning.change = select(settles, noWrench<Lanes>().twist, turning.change);
  turning.turn_number = settles ? Lanes{} : turning.turn_number;
}

/// Implements FlightKernel::predictRowVelocity for the lanes from `at` on.
template <class Matrices>
void predictRowVelocity(RowLanes& bodies, int at, const Mask&) {
  growResistance<Matrices>(bodies, at);
  const Matrices inertia(bodies.inertia, at), inverse(bodies.inverse_inertia, at);
  const Orientations q = loadOrientation(bodies.orientation, at);
  const Lanes duration = load(bodies.kick_time + at);
  const Spatials x = load6(bodies.twist_B, at);
  const Pairs motion{x, inertia * x};

  const Spatials wrench = externalWrench(bodies, at, q);
  Spatials kick = duration * (inverse * wrench);
  if (bodies.has_loads) {
    // Equal to dt K^-1 F to first order, but never reverses the motion, for any dt.
    const Spatials load_B = load6(bodies.load_B, at);
    const Pairs response{inverse * load_B, load_B};
    const Pairs moved = whereViscous(
        bodies, at, true, [&] { return passiveKick(motion, motion, response, duration); },
        [&] {
          return withResistance<Matrices>(bodies, at, [&](const auto& terms) {
            return viscousKick<Lanes>(motion, motion, response, noWrench<Lanes>(), terms, duration);
          });
        });
    kick = kick + (moved.twist - x);
  }
  TurningsOf<Lanes> turning = computeTurnings<Lanes>(inertia, inverse, motion, duration);
  Spatials push = inertia * kick;
  if (anyOf(load(bodies.settling + at) > Lanes{}))
    settleInStep<Matrices>(bodies, at, motion, wrench, kick, push, turning);
  const Spatials turning_W = toWorld(q, turning.share() * turning.change);
  Spatials change_W = turning_W + toWorld(q, kick);
  change_W.linear = change_W.linear + duration * load(bodies.acceleration_W, at);
  store6(bodies.change_W, at, change_W);
  store6(bodies.turning_W, at, turning_W);
  store6(bodies.isotropic_excess_W, at, toWorld(q, isotropicExcess(bodies, at, {kick, push})));
  store(bodies.turn_number + at, turning.turn_number);
}

/// Implements FlightKernel::conserve for the lanes from `at` on.
template <class Matrices>
void conserve(RowLanes& bodies, int at, const Mask&) {
  const Matrices inertia(bodies.inertia, at), inverse(bodies.inverse_inertia, at);
  const Orientations q = loadOrientation(bodies.orientation, at);
  const Spatials x = toBody(q, load6(bodies.velocity_W, at));
  const Spatials turning = toBody(q, load6(bodies.turning_W, at));
  const Spatials by_rows = toBody(q, load6(bodies.by_rows_W, at));
  const Spatials kept = x - turning;
  const Pairs kept_pair{kept, inertia * kept};
  store6(bodies.momentum_W, at, toWorld(q, kept_pair.momentum));
  const Lanes duration = load(bodies.kick_time + at);
  store(bodies.moved_turn_number + at,
        computeTurnings<Lanes>(inertia, inverse, {x, inertia * x}, duration).turn_number);
  const Lanes on_turning = 2 * dot(turning, inertia * by_rows);
  const Lanes by_rows_energy = on_turning < Lanes{} ? on_turning : Lanes{};
  store(bodies.twice_energy + at, inner(kept_pair, kept_pair) + by_rows_energy);
}

/// Implements FlightKernel::transport for the lanes from `at` on.
template <class Matrices>
void transport(RowLanes& bodies, int at, const Mask&) {
  const Orientations q = loadOrientation(bodies.orientation, at);
  Spatials m = load6(bodies.momentum_W, at);
  m.angular = m.angular - cross(load(bodies.displacement_W, at), m.linear);
  const Spatials m_B = toBody(q, m);
  store6(bodies.momentum_B, at, m_B);
  store6(bodies.twist_B, at, Matrices(bodies.inverse_inertia, at) * m_B);
}

inline Pairs motionOf(const FlightLanes& bodies, int at) {
  return {load6(bodies.twist_B, at), load6(bodies.momentum_B, at)};
}
inline void setMotion(FlightLanes& bodies, int at, const Mask& active, const Pairs& x) {
  const Pairs now = select(active, x, motionOf(bodies, at));
  store6(bodies.twist_B, at, now.twist);
  store6(bodies.momentum_B, at, now.momentum);
}

template <class Matrices>
void applyGravity(FlightLanes& bodies, int at, const Mask& active) {
  const Matrices inverse(bodies.inverse_inertia, at);
  const Orientations q = loadOrientation(bodies.orientation, at);
  Spatials wrench = externalWrench(bodies, at, q);
  if (bodies.has_resistance) {
    if (anyOf(load(bodies.settling + at) > Lanes{})) {
      const Pairs x = motionOf(bodies, at);
      const Spatials turning = turningWrench(Matrices(bodies.inertia, at), x);
      wrench = select(settledOf<Matrices>(bodies, at, x, turning), wrench + turning, wrench);
    }
  }
  const Pairs fall = 0.5 * load(bodies.kick_time + at) * Pairs{inverse * wrench, wrench};
  store6(bodies.gravity_twist, at, fall.twist);
  store6(bodies.gravity_momentum, at, fall.momentum);
  // Bodies with a resistance fall in sample() and kick().
  const Mask falls = bodies.has_resistance ? active & ~viscousOf(bodies, at) : active;
  setMotion(bodies, at, falls, motionOf(bodies, at) + fall);
  if (!bodies.has_loads) return;
  store6(bodies.predicted_load_B, at, toBody(q, load6(bodies.load_W, at)));
}

template <class Matrices>
void sample(FlightLanes& bodies, int at, const Mask&) {
  growResistance<Matrices>(bodies, at);
  sampleLoad<Matrices>(bodies, at, motionOf(bodies, at), 0.5 * load(bodies.kick_time + at), true);
}

template <class Matrices>
void kick(FlightLanes& bodies, int at, const Mask& active) {
  growResistance<Matrices>(bodies, at);
  Pairs x = motionOf(bodies, at);
  if (bodies.has_loads)
    x = underLoad<Matrices>(bodies, at, active, x, load(bodies.kick_time + at), true);
  Pairs fallen = x + Pairs{load6(bodies.gravity_twist, at), load6(bodies.gravity_momentum, at)};
  if (bodies.has_resistance) fallen = select(viscousOf(bodies, at), x, fallen);
  setMotion(bodies, at, active, fallen);
}

// Twice the kinetic energy, the potential energy of forces that are constant over the step, eq.
// (25a), and what of it the way since the start has added [J].
struct Energies {
  Lanes kinetic2, potential, risen;
};
inline Energies energies(const FlightLanes& bodies, int at) {
  const Pairs x = motionOf(bodies, at);
  const Vectors buoyancy = load(bodies.buoyancy_W, at);
  const Vectors arm =
      loadOrientation(bodies.orientation, at).toWorld(load(bodies.centre_of_volume_B, at));
  const Vectors force = load(bodies.force_W, at) + buoyancy;
  const Lanes risen = Lanes{} - dot(force, load(bodies.displacement_W, at));
  return {inner(x, x), risen - dot(buoyancy, arm), risen};
}

void measureEnergy(FlightLanes& bodies, int at, const Mask&) {
  const Energies now = energies(bodies, at);
  store(bodies.energy + at, 0.5 * now.kinetic2 + now.potential);
}

void withinEnergy(FlightLanes& bodies, int at, const Mask& active) {
  const Lanes zero = Lanes{};
  const Vectors torque = load(bodies.torque_W, at);
  const Energies now = energies(bodies, at);
  const Lanes left = load(bodies.energy + at) - now.potential;
  const Lanes allowed = larger(2 * left, zero);
  const Mask gains = active & (now.kinetic2 > allowed) & (dot(torque, torque) == zero);
  if (!anyOf(gains)) return;
  const Mask rises = gains & (left < zero) & (now.risen > zero);
  const Lanes back = rises ? zero - larger(left, zero - now.risen) : zero;
  const Lanes kept = zero + 1 - back / (rises ? now.risen : zero + 1);
  store(bodies.displacement_W, at, kept * load(bodies.displacement_W, at));
  const Lanes removed = gains ? 0.5 * (now.kinetic2 - allowed) + back : zero;
  store(bodies.energy_removed + at, load(bodies.energy_removed + at) + removed);
  setMotion(bodies, at, gains, scaleWithin(now.kinetic2, allowed) * motionOf(bodies, at));
}

// Runs a step for all registers with an active body, that for diagonal matrices if all bodies have
// them.
template <auto kDiagonal, auto kFull, class AnyLanes>
void forAll(AnyLanes& bodies) noexcept {
  for (int at = 0; at < kFlightLanes; at += kWidth) {
    const Mask active = load(bodies.active + at) > Lanes{};
    if (!anyOf(active)) continue;
    // NOLINTNEXTLINE(bugprone-branch-clone): some steps are the same for both.
    if (bodies.has_diagonal_inertia) {
      kDiagonal(bodies, at, active);
    } else {
      kFull(bodies, at, active);
    }
  }
}

}  // namespace

const FlightKernel AMBIENT_KERNEL(kFlightKernel){
    readStarts,
    findEnds,
    forAll<drift<DiagonalMatrices>, drift<FullMatrices>>,
    forAll<applyGravity<DiagonalMatrices>, applyGravity<FullMatrices>>,
    forAll<sample<DiagonalMatrices>, sample<FullMatrices>>,
    forAll<kick<DiagonalMatrices>, kick<FullMatrices>>,
    forAll<measureEnergy, measureEnergy>,
    forAll<withinEnergy, withinEnergy>,
    forAll<predictRowVelocity<DiagonalMatrices>, predictRowVelocity<FullMatrices>>,
    forAll<conserve<DiagonalMatrices>, conserve<FullMatrices>>,
    forAll<transport<DiagonalMatrices>, transport<FullMatrices>>};

}  // namespace ambient
