#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <list>
#include <stdexcept>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/members/attach.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/fluid.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/immersed/floating_state.h"
#include "bullet_ambient/impulse.h"
#include "bullet_ambient/motion/links/link_dynamics.h"
#include "bullet_ambient/motion/rows/row_velocity.h"
#include "bullet_ambient/robot_dynamics.h"

AMBIENT_BEGIN
namespace {

// Copy of the present pose and velocity of a btMultiBody, and of the fluid around its links.
class TreeNow {
 public:
  TreeNow(const AmbientTrees& trees, const btMultiBody& body);

  // Returns the equations of motion of the tree at its pose. The TreeNow must outlive them.
  LinkDynamics dynamics() const;
  // Adds the surface loads at the present velocity to the applied forces of the links.
  void applyLoads();

  Coordinates velocity;

 private:
  void immerse(AmbientLink& ambient, const btMultiBody& body, const Vector3& gravity);

  LinkTree tree_;
  std::list<BodyModel> models_;  // tree_ holds pointers to them
  TreePose pose_;
};

TreeNow::TreeNow(const AmbientTrees& trees, const btMultiBody& body) : tree_(makeLinkTree(body)) {
  const Vector3 gravity =
      trees.world() ? toVector3(trees.world()->getGravity()) : Vector3(Vector3::Zero());
  for (Link& link : tree_.links) link.surroundings.applied = weight(link.mass, gravity);
  if (const AmbientTree* tree = trees.find(&body))
    for (const auto& link : tree->links) immerse(*link, body, gravity);
  readPose(body, pose_);
  velocity.resize(coordinateCount(tree_));
  readVelocity(body, velocity);
}

LinkDynamics TreeNow::dynamics() const {
  LinkDynamics dynamics(tree_);
  dynamics.setPose(pose_);
  return dynamics;
}

void TreeNow::applyLoads() {
  LinkDynamics at_rest = dynamics();
  at_rest.setVelocity(velocity);
  for (int i = 0; i < tree_.size(); ++i) {
    Link& link = tree_.links[i];
    if (!link.model || !link.model->loads) continue;
    const Twist x = at_rest.relativeTwist(i);
    const Wrench load = wholeLoad(computeSurfaceLoad(*link.model, x, link.surroundings),
                                  link.model->resistance.get(), x);
    const Matrix3& R = at_rest.rotation(i);
    link.surroundings.applied += {R * load.torque, R * load.force};
  }
}

void TreeNow::immerse(AmbientLink& ambient, const btMultiBody& body, const Vector3& gravity) {
  if (!ambient.ambient.isInFluid()) return;
  readLinkPose(body, ambient);
  Link& link = tree_.links[ambient.link + 1];
  models_.push_back(modelNow(ambient.ambient, ambient.now));
  link.model = &models_.back();
  link.surroundings.gravity = gravity;
  link.surroundings.ambient_velocity = ambient.ambient.medium.velocity;
  link.surroundings.ambient_acceleration = ambient.ambient.medium.acceleration;
  link.surroundings.load_scale = ambient.ambient.load_scale;
  addFlowAlong(ambient.ambient, ambient.now.state.orientation, link.surroundings);
}

// Returns the velocity change of a body per unit impulse at its centre of mass, 6x6 in world axes:
// K^-1, or with locked axes K_eff^-1 of docs/theory.md eq. (30). Takes the present mass, pose and
// waterline.
Matrix6 inverseInertia(AmbientBody& ambient) {
  const btRigidBody& body = *ambient.body;
  const InverseMass mass = inverseMassOf(body);
  if (isModelStale(ambient, mass)) rebuildModels(ambient, mass);
  const MotionView now = motionOf(body);
  const Matrix3 R = now.rotation();
  const AxisFactors factors = axisFactors(body);
  const BodyModel model = modelNow(ambient, now);
  if (factors.areFree()) return rotateAxes(model.inverse_inertia, R);
  return lockedInverse(rotateAxes(model.inertia, R), factors);
}

// Adds the velocity change by an impulse at the centre of mass to the velocity of a body. A body
// without fluid responds with its dry mass.
void applyImpulseToBody(AmbientBody& ambient, const Wrench& impulse) {
  btRigidBody& body = *ambient.body;
  if (!ambient.isInFluid() || body.isStaticOrKinematicObject()) {
    body.applyCentralImpulse(toBullet(impulse.force));
    body.applyTorqueImpulse(toBullet(impulse.torque));
    return;
  }
  addVelocity(body, Twist::fromVector(inverseInertia(ambient) * impulse.vector()));
}

// Adds the change H^-1 J^T impulse to the velocities of a tree. `impulse` acts at the centre of
// mass of `link` (Bullet's number).
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

// Stock: each axis scaled by its factor, as applyImpulse() has it.
btMatrix3x3 dryInverseMass(const btRigidBody& body, const btVector3& r) {
  btMatrix3x3 result;
  for (int axis = 0; axis < 3; ++axis) {
    btVector3 impulse(0, 0, 0);
    impulse[axis] = body.getLinearFactor()[axis];
    const btVector3 spin =
        body.getInvInertiaTensorWorld() * r.cross(impulse) * body.getAngularFactor();
    const btVector3 change = impulse * body.getInvMass() + spin.cross(r);
    for (int row = 0; row < 3; ++row) result[row][axis] = change[row];
  }
  return result;
}

}  // namespace

void Immersed::applyImpulse(const Wrench& impulse) const {
  const Access access = require("applyImpulse");
  const AmbientTrees& trees = access.bodies->trees;
  if (access.ambient->body) {
    applyImpulseToBody(*access.ambient, impulse);
  } else {
    applyImpulseToLink(trees, trees.treeOf(*access.ambient), trees.linkOf(*access.ambient).link,
                       impulse);
  }
  wake(*access.ambient);
}

btMatrix3x3 inverseEffectiveMass(const Fluid& fluid, const btRigidBody& body,
                                 const btVector3& relative_position) {
  AmbientBody* ambient = ambientBodiesOf(fluid).find(&body);
  if (!ambient || !ambient->isInFluid() || body.isStaticOrKinematicObject())
    return dryInverseMass(body, relative_position);
  const Matrix6 response = inverseInertia(*ambient);
  const Matrix3 r = crossMatrix(toVector3(relative_position));
  // J^T K^-1 J with the wrench J f = (r x f, f) of an impulse f.
  Matrix3 result = response.bottomRightCorner<3, 3>() + response.bottomLeftCorner<3, 3>() * r -
                   r * response.topRightCorner<3, 3>() - r * response.topLeftCorner<3, 3>() * r;
  result = 0.5 * (result + result.transpose()).eval();
  return toBulletMatrix(result);
}

Eigen::MatrixXd ambientMassMatrix(const Fluid& fluid, const btMultiBody& multi_body) {
  return TreeNow(ambientBodiesOf(fluid).trees, multi_body).dynamics().massMatrix();
}

Eigen::VectorXd ambientInverseDynamics(const Fluid& fluid, const btMultiBody& multi_body,
                                       const Eigen::VectorXd& acceleration) {
  TreeNow now(ambientBodiesOf(fluid).trees, multi_body);
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
  const TreeNow now(ambientBodiesOf(fluid).trees, multi_body);
  return now.dynamics().kineticEnergy(now.velocity);
}

AMBIENT_END
