#pragma once

#include "bullet_ambient/motion/lanes/motion_lanes.h"
#include "bullet_ambient/motion/lanes/row_lanes.h"
#include "bullet_ambient/motion/lanes/turning_kernel.h"

// Only for sources compiled once per instruction set, see lanes.h.

namespace ambient {
namespace {

/// Implements FlightKernel::keep for the lanes from `at` on.
struct KeepStep {
  template <class Matrices>
  static void act(RowMotionLanes& lanes, int at) {
    const FlightLanes& bodies = lanes.bodies;
    const Matrices inertia(bodies.inertia, at), inverse(bodies.inverse_inertia, at);
    const Orientations q = orientationOf(bodies, at);
    const Spatials x = toBody(q, load6(lanes.velocity_W, at));
    const Spatials share = toBody(q, load6(lanes.turning_W, at));
    const Spatials by_rows = toBody(q, load6(lanes.by_rows_W, at));
    const Spatials kept = x - share;
    const Pairs kept_pair{kept, inertia * kept};
    store6(lanes.momentum_W, at, toWorld(q, kept_pair.momentum));
    const Lanes duration = load(bodies.kick_time + at);
    store(lanes.extent + at, computeTurnings(inertia, inverse, {x, inertia * x}, duration).extent);
    const Lanes on_share = 2 * dot(share, inertia * by_rows);
    const Lanes taken = on_share < Lanes{} ? on_share : Lanes{};
    store(lanes.twice_energy + at, inner(kept_pair, kept_pair) + taken);
  }
};

/// Implements FlightKernel::carry for the lanes from `at` on.
struct CarryStep {
  template <class Matrices>
  static void act(RowMotionLanes& lanes, int at) {
    FlightLanes& bodies = lanes.bodies;
    const Orientations q = orientationOf(bodies, at);
    Spatials m = load6(lanes.momentum_W, at);
    m.angular = m.angular - cross(load(bodies.way_W, at), m.linear);
    const Spatials m_B = toBody(q, m);
    store6(bodies.momentum_B, at, m_B);
    store6(bodies.twist_B, at, Matrices(bodies.inverse_inertia, at) * m_B);
  }
};

}  // namespace
}  // namespace ambient
