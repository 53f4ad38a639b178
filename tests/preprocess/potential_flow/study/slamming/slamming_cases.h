#pragma once

#include "tests/preprocess/potential_flow/study/image_flow/surface_cases.h"

namespace ambient::study {

/// A ball of radius 1 [m].
SurfaceCase makeBallCase();

/// Half of the wedge's breadth at its deck [m].
constexpr double kHalfBreadth = 1;

/// A wedge with its keel below, along x, and a flat deck; deadrise [rad], length [m]. Solved by the
/// preprocessor's defaults.
SurfaceCase makeWedgeCase(double deadrise, double length);

/// Water surface for the added mass during entry: raised, or undisturbed.
enum class EntrySurface { kRaised, kUndisturbed };

/// Added mass in heave per density, body's frame upright, lowest point at the depth `draught`
/// [m^3].
double heaveInertia(const SurfaceModel& model, double draught, EntrySurface surface);

/// Force over rho V^2 on a body that sinks at constant speed V, much faster than its waves. Equals
/// d K / d draught; docs/theory.md eq. (67) for theta = 1 [m^2].
double slammingForce(const SurfaceModel& model, double draught, EntrySurface surface);

}  // namespace ambient::study
