#pragma once

#include <array>
#include <utility>

namespace ambient {

/// Integrator of free flight over one step of the world.
enum class Integrator {
  kPassiveLeapfrog,  ///< default: energy cannot grow at any step, one load evaluation per substep
  kDormandPrince,    ///< accurate: orders 5 and 4 with error control, six evaluations per substep
  kRungeKutta4,      ///< Padilla 2025: |w| h < 5.7 degrees, four load evaluations per substep
  kSymplecticEuler,  ///< default of Padilla 2025: one evaluation per substep; may be unstable
};

/// Names of the integrators in scenes and summaries.
constexpr std::array<std::pair<Integrator, const char*>, 4> kIntegratorNames{
    {{Integrator::kPassiveLeapfrog, "leapfrog"},
     {Integrator::kDormandPrince, "dormand_prince"},
     {Integrator::kRungeKutta4, "rk4"},
     {Integrator::kSymplecticEuler, "symplectic_euler"}}};

struct FlightSettings {
  Integrator integrator = Integrator::kPassiveLeapfrog;
  double tolerance =
      1e-3;  ///< leapfrog: velocity error per substep relative to the motion [1], docs eq. (25);
             ///< Dormand-Prince: also error of orientation [rad] and position [body lengths]
  /// Largest number of substeps per step. 0: leapfrog 16 (64 for bodies lighter than their added
  /// mass), Dormand-Prince 1024, RK4 4096. 1: fast mode of the leapfrog, one evaluation per step.
  /// Symplectic Euler takes exactly this number; 0: one.
  int max_substeps = 0;
};

}  // namespace ambient
