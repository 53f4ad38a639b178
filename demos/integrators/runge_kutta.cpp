#include <algorithm>
#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "demos/integrators/integrators.h"
#include "demos/integrators/momentum_equations.h"

namespace ambient {
namespace {

constexpr double kMaxTurn = 5.7 * kPi / 180;  // [rad] per substep
constexpr int kMostSubsteps = 4096;

MomentumPhase step(const MomentumEquations& equations, const MomentumPhase& s, double h) {
  const MomentumPhase k1 = equations.rate(s);
  const MomentumPhase k2 = equations.rate(s.plus(h / 2, k1));
  const MomentumPhase k3 = equations.rate(s.plus(h / 2, k2));
  const MomentumPhase k4 = equations.rate(s.plus(h, k3));
  MomentumPhase end = s.plus(h / 6, k1).plus(h / 3, k2).plus(h / 3, k3).plus(h / 6, k4);
  end.orientation.normalize();
  return end;
}

}  // namespace

FlightResult flyRungeKutta(const FlightTask& task, const RigidState& start,
                           const FlightMemory&) noexcept {
  const int most = task.settings.max_substeps > 0 ? task.settings.max_substeps : kMostSubsteps;
  const double wanted = std::ceil(start.twist.angular.norm() * task.duration / kMaxTurn);
  const int substeps = wanted < most ? std::max(1, static_cast<int>(wanted)) : most;
  FlightResult flight{start, {}, {}};
  flight.count.substeps = substeps;
  flight.count.coarse = wanted > most;
  flight.count.error = flight.count.coarse ? 1 : 0;
  const MomentumEquations equations(task, start, flight.count);
  MomentumPhase s = equations.start();
  for (int i = 0; i < substeps; ++i) s = step(equations, s, task.duration / substeps);
  flight.state = equations.stateOf(s);
  return flight;
}

}  // namespace ambient
