#pragma once

#include "tests/preprocess/potential_flow/study/surface_cases.h"

namespace ambient::study {

/// A ball of radius 1 [m].
SurfaceCase makeBallCase();

/// Half of the wedge's breadth at its deck [m].
constexpr double kHalfBreadth = 1;

/// A wedge with its keel along x, down, and a flat deck; deadrise [rad], length [m]. Solved as the
/// preprocessor does by default.
SurfaceCase makeWedgeCase(double deadrise, double length);

/// How the water's inertia sees the surface around a body that enters.
enum class EntrySurface { kRaised, kUndisturbed };

/// Of the water for heave, per density, with the body's frame upright and its lowest point so deep
/// [m^3].
double heaveInertia(const SurfaceModel& model, double draught, EntrySurface surface);

/// Force over rho V^2 on a body that sinks at a constant speed V, much faster than its waves: the
/// rate of its momentum, d K / d draught; docs/theory.md eq. (67) for theta = 1 [m^2].
double slammingForce(const SurfaceModel& model, double draught, EntrySurface surface);

}  // namespace ambient::study
