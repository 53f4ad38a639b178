#include "bullet_ambient/motion/runge_kutta.h"

#include <algorithm>
#include <cmath>

#include "bullet_ambient/motion/kirchhoff.h"

namespace ambient {
namespace {

constexpr double kMaxTurn = 5.7 * 3.14159265358979323846 / 180;  // [rad] per substep
constexpr int kMostSubsteps = 4096;

// Unknowns of the ordinary differential equation; the orientation need not be normalised between
// stages.
struct Phase {
  Eigen::Vector4d orientation;
  Vector3 position;
  Vector3 linear;   // P, world axes
  Vector3 angular;  // L about the pivot, world axes

  Phase plus(double h, const Phase& rate) const {
    return {orientation + h * rate.orientation, position + h * rate.position,
            linear + h * rate.linear, angular + h * rate.angular};
  }
};

Quaternion unit(const Eigen::Vector4d& q) {
  return Quaternion(q[3], q[0], q[1], q[2]).normalized();
}

class Equations {
 public:
  Equations(const FlightTask& task, const Vector3& pivot, FlightCount& count)
      : task_(task), pivot_(pivot), count_(count) {}

  Phase rate(const Phase& s) const {
    const Quaternion q = unit(s.orientation);
    const Twist x = twistOf(task_.model, {s.linear, s.angular, pivot_}, q, s.position);
    Wrench wrench = externalWrench(task_.model, task_.surroundings, q);
    if (task_.model.has_surface_loads) {
      const SurfaceLoad load = computeSurfaceLoad(task_.model, x);
      ++count_.load_evaluations;
      count_.guarded += load.guarded;
      wrench += load.wrench;
    }
    const Vector3 force = q * wrench.force;
    const Quaternion spin(0, x.angular.x(), x.angular.y(), x.angular.z());
    return {0.5 * (q * spin).coeffs(), q * x.linear, force,
            q * wrench.torque + (s.position - pivot_).cross(force)};
  }

  Phase step(const Phase& s, double h) const {
    const Phase k1 = rate(s);
    const Phase k2 = rate(s.plus(h / 2, k1));
    const Phase k3 = rate(s.plus(h / 2, k2));
    const Phase k4 = rate(s.plus(h, k3));
    Phase end = s.plus(h / 6, k1).plus(h / 3, k2).plus(h / 3, k3).plus(h / 6, k4);
    end.orientation.normalize();
    return end;
  }

 private:
  const FlightTask& task_;
  const Vector3& pivot_;
  FlightCount& count_;
};

}  // namespace

FlightResult flyRungeKutta(const FlightTask& task, const RigidState& start) noexcept {
  const int most = task.settings.max_substeps > 0 ? task.settings.max_substeps : kMostSubsteps;
  const double wanted = std::ceil(start.twist.angular.norm() * task.duration / kMaxTurn);
  const int substeps = wanted < most ? std::max(1, static_cast<int>(wanted)) : most;
  const WorldMomentum momentum = worldMomentum(task.model, start);
  FlightResult flight{start, {}, {}};
  flight.count.substeps = substeps;
  flight.count.coarse = wanted > most;
  const Equations equations(task, momentum.pivot, flight.count);
  Phase s{start.orientation.coeffs(), start.position, momentum.linear, momentum.angular};
  for (int i = 0; i < substeps; ++i) s = equations.step(s, task.duration / substeps);
  flight.state.orientation = unit(s.orientation);
  flight.state.position = s.position;
  flight.state.twist = twistOf(task.model, {s.linear, s.angular, momentum.pivot},
                               flight.state.orientation, s.position);
  return flight;
}

}  // namespace ambient
