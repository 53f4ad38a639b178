#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "demos/analysis/motion_sample.h"
#include "demos/scene/scene.h"
#include "demos/simulation/body_preparation.h"

namespace ambient {

/// Work done for one body by the fluid; zero for bodies without fluid.
struct FlightWork {
  long long substeps = 0;
  long long load_evaluations = 0;
  long long guarded = 0;  ///< evaluations in which the passivity guard acted
  long long coarse = 0;   ///< steps that stayed above the integrator's tolerance
  /// 1 where the errors of the steps add up: they are too long for the motion.
  long long too_long = 0;
  long long halted = 0;       ///< steps at the surface of water that ended early
  double energy_removed = 0;  ///< by bounds on the energy of steps [J]
};

/// A stock btDiscreteDynamicsWorld with the bodies of a scene in their fluid.
class Simulation {
 public:
  /// `bodies` are those of the scene, in its order.
  /// @throws std::invalid_argument naming the scene's file and the body if its values are not
  /// physical.
  Simulation(const Scene& scene, const std::vector<PreparedBody>& bodies);
  ~Simulation();

  /// One step of scene.time_step.
  /// @throws std::runtime_error naming the scene's file, body and time if a state is not finite.
  void step();

  /// Steps made so far times the step [s].
  double time() const;

  /// Motion of all bodies now, in the order of the scene.
  std::vector<MotionSample> sample() const;

  FlightWork work(std::size_t body) const;

  /// Adds a force [N] that acts at a point [m] during the next step; world axes.
  void applyForce(std::size_t body, const Vector3& force, const Vector3& point);
  /// The same for a torque [N m].
  void applyTorque(std::size_t body, const Vector3& torque);

  /// Changes the fluid around a body, as AmbientRegistry::setMedium().
  /// @throws std::invalid_argument naming the body if the fluid does not act on it or the medium is
  /// not physical.
  void setMedium(std::size_t body, const Medium& medium);

  /// Everything that changes from step to step, as bytes; applied forces included.
  std::string saveState() const;
  /// Goes on from there in this simulation or another one of the same scene, bit for bit where
  /// ambient::restoreState() does: contacts of bodies that move are those of compound shapes.
  /// @throws std::runtime_error or std::invalid_argument, one sentence, if the bytes are damaged or
  /// of another scene; the simulation then stays as it was.
  void restoreState(std::string_view bytes);

  /// What the library has reported last, one sentence; empty: nothing.
  const std::string& warning() const;

 private:
  struct World;
  std::unique_ptr<World> world_;
};

}  // namespace ambient
