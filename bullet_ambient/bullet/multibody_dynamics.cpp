#include "bullet_ambient/bullet/multibody_dynamics.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <list>
#include <stdexcept>
#include <string>

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/bullet/tree_state.h"
#include "bullet_ambient/force/buoyancy.h"
#include "bullet_ambient/motion/link_dynamics.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

// A tree of its own, as the btMultiBody is now.
class TreeNow {
 public:
  TreeNow(const AmbientRegistry& registry, const btMultiBody& body) : tree_(makeLinkTree(body)) {
    const AmbientTrees& trees = bodiesOf(registry).trees;
    const Vector3 gravity =
        trees.world() ? toVector3(trees.world()->getGravity()) : Vector3(Vector3::Zero());
    for (Link& link : tree_.links) link.surroundings.applied = weight(link.mass, gravity);
    if (const AmbientTree* tree = trees.find(&body))
      for (const auto& link : tree->links) immerse(*link, body, gravity);
    readPose(body, pose_);
    velocity.resize(coordinateCount(tree_));
    readVelocity(body, velocity);
  }

  LinkDynamics dynamics() const {
    LinkDynamics dynamics(tree_);
    dynamics.setPose(pose_);
    return dynamics;
  }

  void applyLoads() {
    LinkDynamics at_rest = dynamics();
    at_rest.setVelocity(velocity);
    for (int i = 0; i < tree_.size(); ++i) {
      Link& link = tree_.links[i];
      if (!link.model || !link.model->loads) continue;
      const Wrench load = computeSurfaceLoad(*link.model, at_rest.relativeTwist(i)).wrench;
      const Matrix3& R = at_rest.rotation(i);
      link.surroundings.applied += {R * load.torque, R * load.force};
    }
  }

  Coordinates velocity;

 private:
  void immerse(AmbientLink& ambient, const btMultiBody& body, const Vector3& gravity) {
    if (!ambient.ambient.isInFluid()) return;
    ambient.stand_in.setWorldTransform(linkTransform(body, ambient.link));
    Link& link = tree_.links[ambient.link + 1];
    models_.push_back(modelNow(ambient.ambient));
    link.model = &models_.back();
    link.surroundings.gravity = gravity;
    link.surroundings.ambient_velocity = ambient.ambient.medium.velocity;
    link.surroundings.ambient_acceleration = ambient.ambient.medium.acceleration;
  }

  LinkTree tree_;
  std::list<BodyModel> models_;  // the tree points at them
  TreePose pose_;
};

}  // namespace

Eigen::MatrixXd ambientMassMatrix(const AmbientRegistry& registry, const btMultiBody& multi_body) {
  return TreeNow(registry, multi_body).dynamics().massMatrix();
}

Eigen::VectorXd ambientInverseDynamics(const AmbientRegistry& registry,
                                       const btMultiBody& multi_body,
                                       const Eigen::VectorXd& acceleration) {
  TreeNow now(registry, multi_body);
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

double kineticEnergy(const AmbientRegistry& registry, const btMultiBody& multi_body) {
  const TreeNow now(registry, multi_body);
  return now.dynamics().kineticEnergy(now.velocity);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
