#pragma once

#include "bullet_ambient/immersed/ambient_body.h"

AMBIENT_BEGIN

// States of several bodies of Bullet, read side by side. `count`: at most kFlightsTogether.

/// Attitudes of bodies, and twists in their axes.
struct Attitudes {
  Quaternion orientations[kFlightsTogether];  ///< B to W, unit
  Twist twists_B[kFlightsTogether];
};

/// Reads the orientations of bodies and turns one twist of each into its axes.
void readAttitudes(AmbientBody* const* bodies, const Twist* twists_W, int count,
                   Attitudes& attitudes) noexcept;

/// Bodies at the start of a step.
struct Departures {
  Twist twists_W[kFlightsTogether];  ///< velocities in Bullet
  RigidState states[kFlightsTogether];
  Surroundings surroundings[kFlightsTogether];
};

void readDepartures(AmbientBody* const* bodies, int count, Departures& departures) noexcept;

AMBIENT_END
