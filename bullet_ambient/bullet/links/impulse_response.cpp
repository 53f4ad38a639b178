#include "bullet_ambient/bullet/links/impulse_response.h"

#include <stdexcept>
#include <vector>

#include "bullet_ambient/bullet/links/tree_now.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/immersed/surface_encounter.h"
#include "bullet_ambient/motion/rows/axis_locks.h"

AMBIENT_BEGIN

Matrix6 inverseInertia(AmbientBody& ambient) {
  if (isModelStale(ambient)) rebuildModels(ambient);
  const btRigidBody& body = *ambient.body;
  const Matrix3 R = readState(body).orientation.toRotationMatrix();
  const AxisFactors factors = axisFactors(body);
  const BodyModel model = modelNow(ambient);
  if (factors.areFree()) return rotateAxes(model.inverse_inertia, R);
  return lockedInverse(rotateAxes(model.inertia, R), factors);
}

void applyImpulseToBody(AmbientBody& ambient, const Wrench& impulse) {
  btRigidBody& body = *ambient.body;
  if (!ambient.isInFluid() || body.isStaticOrKinematicObject()) {
    body.applyCentralImpulse(toBullet(impulse.force));
    body.applyTorqueImpulse(toBullet(impulse.torque));
    return;
  }
  const Twist change = Twist::fromVector(inverseInertia(ambient) * impulse.vector());
  body.setAngularVelocity(body.getAngularVelocity() + toBullet(change.angular));
  body.setLinearVelocity(body.getLinearVelocity() + toBullet(change.linear));
}

void applyImpulseToLink(const AmbientTrees& trees, const AmbientTree& tree, int link,
                        const Wrench& impulse) {
  const TreeNow now(trees, *tree.multi_body);
  LinkDynamics dynamics = now.dynamics();
  if (!dynamics.factor()) {
    throw std::invalid_argument(
        "applyImpulse: the masses of this btMultiBody have no inverse; they must be positive");
  }
  const int number = link + 1;  // index in the tree: the base is 0
  const Matrix3 to_link = dynamics.rotation(number).transpose();
  std::vector<Wrench> wrenches(static_cast<std::size_t>(dynamics.tree().size()));
  wrenches[static_cast<std::size_t>(number)] = {to_link * impulse.torque, to_link * impulse.force};
  Coordinates change(dynamics.coordinates());
  dynamics.respond(wrenches, change);
  addVelocity(*tree.multi_body, change);
}

AMBIENT_END
