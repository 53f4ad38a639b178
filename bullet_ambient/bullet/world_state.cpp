#include "bullet_ambient/bullet/world_state.h"

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/bullet/ambient_registry.h"
#include "bullet_ambient/bullet/ambient_state.h"
#include "bullet_ambient/bullet/body_state.h"
#include "bullet_ambient/bullet/contact_state.h"
#include "bullet_ambient/bullet/multibody_state.h"
#include "bullet_ambient/bullet/world_objects.h"
#include "bullet_ambient/bullet/world_state_faults.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

void checkCount(const char* what, std::size_t saved, std::size_t found) {
  if (saved == found) return;
  std::ostringstream sentence;
  sentence << "restoreState: the state has " << saved << ' ' << what << ", but the world has "
           << found;
  throw std::invalid_argument(sentence.str());
}

void checkNumbers(const WorldState& state) {
  const std::string fault = findFault(state);
  if (!fault.empty()) throw std::invalid_argument("restoreState: the saved state " + fault);
}

void checkFits(const WorldState& state, btDynamicsWorld& world, const AmbientRegistry& registry) {
  const auto multi_bodies = multiBodiesOf(world);
  const auto multi_body_joints = multiBodyJointsOf(world);
  checkCount("rigid bodies", state.bodies.size(), rigidBodiesOf(world).size());
  checkCount("multibodies", state.multi_bodies.size(), multi_bodies.size());
  checkCount("joints", state.joints.size(), static_cast<std::size_t>(world.getNumConstraints()));
  checkCount("joints of multibodies", state.multi_body_joints.size(), multi_body_joints.size());
  for (std::size_t i = 0; i < multi_bodies.size(); ++i)
    requireFits(state.multi_bodies[i], *multi_bodies[i], i);
  for (std::size_t i = 0; i < multi_body_joints.size(); ++i)
    requireFits(state.multi_body_joints[i], *multi_body_joints[i], i);
  const btDynamicsWorld* others = bodiesOf(registry).trees.world();
  if (others && others != &world)
    throw std::invalid_argument("restoreState: the registry has links of another world");
}

// Models are built before anything is changed, so that a medium that is refused changes nothing.
std::vector<std::unique_ptr<AmbientBody>> makeAmbientBodies(const WorldState& state,
                                                            const std::vector<btRigidBody*>& bodies,
                                                            AmbientBodies& registered) {
  std::vector<std::unique_ptr<AmbientBody>> result;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    result.emplace_back();
    if (!state.bodies[i].ambient) continue;
    btRigidBody with_mass(1, nullptr, bodies[i]->getCollisionShape());
    restoreMass(state.bodies[i], with_mass);
    result.back() =
        std::make_unique<AmbientBody>(makeAmbient(*state.bodies[i].ambient, with_mass, registered));
    result.back()->body = bodies[i];
  }
  return result;
}

using Links = std::vector<std::unique_ptr<AmbientLink>>;

std::vector<Links> makeAllLinks(const WorldState& state, AmbientBodies& registered) {
  std::vector<Links> result;
  for (const MultiBodyState& body : state.multi_bodies)
    result.push_back(makeLinks(body, registered));
  return result;
}

void restoreMultiBodies(const WorldState& state, std::vector<Links> links, btDynamicsWorld& world,
                        AmbientBodies& registered) {
  const std::vector<btMultiBody*> bodies = multiBodiesOf(world);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    restoreMultiBody(state.multi_bodies[i], *bodies[i]);
    insertLinks(state.multi_bodies[i], std::move(links[i]),
                static_cast<btMultiBodyDynamicsWorld&>(world), *bodies[i], registered);
  }
  const std::vector<btMultiBodyConstraint*> joints = multiBodyJointsOf(world);
  for (std::size_t i = 0; i < joints.size(); ++i)
    restoreJoint(state.multi_body_joints[i], *joints[i]);
}

void restoreJoints(const WorldState& state, btDynamicsWorld& world) {
  for (int i = 0; i < world.getNumConstraints(); ++i) {
    const JointState& joint = state.joints[static_cast<std::size_t>(i)];
    world.getConstraint(i)->setEnabled(joint.is_enabled);
    world.getConstraint(i)->internalSetAppliedImpulse(joint.applied_impulse);
  }
}

btSequentialImpulseConstraintSolver* shufflingSolver(btDynamicsWorld& world) {
  return dynamic_cast<btSequentialImpulseConstraintSolver*>(world.getConstraintSolver());
}

}  // namespace

WorldState saveState(const btDynamicsWorld& world, const AmbientRegistry& registry) {
  // Bullet's accessors are not const.
  auto& source = const_cast<btDynamicsWorld&>(world);
  WorldState state;
  for (const btRigidBody* body : rigidBodiesOf(source)) {
    state.bodies.push_back(saveBody(*body));
    if (const AmbientBody* ambient = bodiesOf(registry).find(body)) {
      state.bodies.back().ambient = saveAmbient(*ambient);
    }
  }
  for (const btMultiBody* body : multiBodiesOf(source)) {
    state.multi_bodies.push_back(saveMultiBody(*body));
    if (const AmbientTree* tree = bodiesOf(registry).trees.find(body))
      saveFluids(*tree, state.multi_bodies.back());
  }
  for (const btMultiBodyConstraint* joint : multiBodyJointsOf(source))
    state.multi_body_joints.push_back(saveJoint(*joint));
  state.pairs = savePairs(source);
  state.contacts = saveContacts(source);
  for (int i = 0; i < source.getNumConstraints(); ++i) {
    btTypedConstraint& joint = *source.getConstraint(i);
    state.joints.push_back({joint.isEnabled(), joint.internalGetAppliedImpulse()});
  }
  state.time = registry.time();
  if (const auto* solver = shufflingSolver(source)) state.random_seed = solver->getRandSeed();
  return state;
}

void restoreState(const WorldState& state, btDynamicsWorld& world, AmbientRegistry& registry) {
  bodiesOf(registry).requireChangeable("restoreState");
  const std::vector<btRigidBody*> bodies = rigidBodiesOf(world);
  checkFits(state, world, registry);
  checkNumbers(state);
  auto ambient_bodies = makeAmbientBodies(state, bodies, bodiesOf(registry));
  std::vector<Links> links = makeAllLinks(state, bodiesOf(registry));

  for (std::size_t i = 0; i < bodies.size(); ++i) {
    registry.detach(*bodies[i]);
    restoreMass(state.bodies[i], *bodies[i]);
    restoreBody(state.bodies[i], *bodies[i]);
    if (ambient_bodies[i]) bodiesOf(registry).insert(std::move(ambient_bodies[i]));
  }
  restoreMultiBodies(state, std::move(links), world, bodiesOf(registry));
  bodiesOf(registry).regions.time = state.time;
  restoreJoints(state, world);
  restoreContacts(state.pairs, state.contacts, world);
  for (std::size_t i = 0; i < bodies.size(); ++i) restoreSleep(state.bodies[i], *bodies[i]);
  const std::vector<btMultiBody*> multi_bodies = multiBodiesOf(world);
  for (std::size_t i = 0; i < multi_bodies.size(); ++i)
    restoreSleep(state.multi_bodies[i], *multi_bodies[i]);
  if (auto* solver = shufflingSolver(world)) solver->setRandSeed(state.random_seed);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
