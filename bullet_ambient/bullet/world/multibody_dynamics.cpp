#include <stdexcept>
#include <string>

#include "bullet_ambient/bullet/links/tree_now.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/fluid.h"
#include "bullet_ambient/robot_dynamics.h"

AMBIENT_BEGIN
Eigen::MatrixXd ambientMassMatrix(const Fluid& fluid, const btMultiBody& multi_body) {
  return TreeNow(membersOf(fluid).trees, multi_body).dynamics().massMatrix();
}

Eigen::VectorXd ambientInverseDynamics(const Fluid& fluid, const btMultiBody& multi_body,
                                       const Eigen::VectorXd& acceleration) {
  TreeNow now(membersOf(fluid).trees, multi_body);
  if (acceleration.size() != now.velocity.size()) {
    throw std::invalid_argument("ambientInverseDynamics: the acceleration has " +
                                std::to_string(acceleration.size()) +
                                " entries, but the btMultiBody has " +
                                std::to_string(now.velocity.size()) + " coordinates");
  }
  now.applyLoads();
  Eigen::VectorXd force(acceleration.size());
  now.dynamics().inverseDynamics(now.velocity, acceleration, force);
  return force;
}

double kineticEnergy(const Fluid& fluid, const btMultiBody& multi_body) {
  const TreeNow now(membersOf(fluid).trees, multi_body);
  return now.dynamics().kineticEnergy(now.velocity);
}

AMBIENT_END
