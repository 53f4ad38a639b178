#pragma once

#include "bullet_ambient/base/elementary.h"
#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// Only for sources compiled once per instruction set, see lanes.h.

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

/// Implements FlightKernel::depart.
inline void depart(DepartureLanes& bodies) noexcept {
  for (int at = 0; at < kFlightLanes; at += kWidth) {
    const Vectors rows[3] = {load(bodies.rotation, at), load(bodies.rotation + 3, at),
                             load(bodies.rotation + 6, at)};
    const Orientations q = orientationsOf(rows);
    const Spatials twist_W = load6(bodies.twist_W, at);
    store(bodies.orientation, at, q.u);
    store(bodies.orientation[3] + at, q.w);
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

/// Implements FlightKernel::arrive.
inline void arrive(ArrivalLanes& bodies) noexcept {
  const Lanes per_duration = all(1 / bodies.duration), least = all(bodies.least);
  for (int at = 0; at < kFlightLanes; at += kWidth) {
    const Orientations q{load(bodies.orientation, at), load(bodies.orientation[3] + at)};
    const Spatials twist_B = load6(bodies.twist_B, at);
    const Spatials twist_W = toWorld(q, twist_B);
    store6(bodies.twist_W, at, withoutTraces(twist_W, least));
    const Orientations start_inverse{zeroVectors() - load(bodies.start_orientation, at),
                                     load(bodies.start_orientation[3] + at)};
    const Vectors turn = rotationVectors(normalized(q * start_inverse));
    const Vectors way = load(bodies.position, at) - load(bodies.start_position, at);
    const Spatials mean_W{per_duration * turn, per_duration * way};
    store6(bodies.mean_W, at, withoutTraces(mean_W, least));
  }
}

}  // namespace
}  // namespace ambient
