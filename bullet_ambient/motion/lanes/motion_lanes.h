#pragma once

#include "bullet_ambient/motion/lanes/spatial_lanes.h"

// Readings of FlightLanes that several kernels make. For sources that are compiled once per
// instruction set, see spatial_lanes.h.

namespace ambient {
namespace {

inline Orientations orientationOf(const FlightLanes& bodies, int at) {
  return {load(bodies.orientation, at), load(bodies.orientation[3] + at)};
}

/// Returns weight, buoyancy and inertial forces of the flow in B, docs/theory.md eq. (18) and (19).
inline Spatials externalWrench(const FlightLanes& bodies, int at, const Orientations& q) {
  const Vectors buoyancy = q.toBody(load(bodies.buoyancy_W, at));
  return {
      q.toBody(load(bodies.torque_W, at)) + cross(load(bodies.centre_of_volume_B, at), buoyancy),
      q.toBody(load(bodies.force_W, at)) + buoyancy};
}

}  // namespace
}  // namespace ambient
