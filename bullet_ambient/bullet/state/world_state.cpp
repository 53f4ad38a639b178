#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/members/ambient_bodies.h"
#include "bullet_ambient/bullet/state/bullet_state.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"
#include "bullet_ambient/saved_state.h"

AMBIENT_BEGIN
namespace {

void checkCount(const char* what, std::size_t saved, std::size_t found) {
  if (saved == found) return;
  throw std::invalid_argument("restoreState: the state has " + std::to_string(saved) + ' ' + what +
                              ", but the world has " + std::to_string(found));
}

void check(const WorldState& state, btDynamicsWorld& world) {
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
  const std::string fault = findFault(state);
  if (!fault.empty()) throw std::invalid_argument("restoreState: the saved state " + fault);
}

// Models are built before anything is changed, so that a medium that is refused changes nothing.
std::vector<std::optional<AmbientBody>> makeAmbientBodies(const WorldState& state,
                                                          const std::vector<btRigidBody*>& bodies,
                                                          AmbientBodies& registered) {
  std::vector<std::optional<AmbientBody>> result;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    result.emplace_back();
    if (!state.bodies[i].ambient) continue;
    const InverseMass mass{static_cast<double>(state.bodies[i].inverse_mass),
                           toVector3(state.bodies[i].inverse_inertia)};
    result.back() =
        makeAmbient(*state.bodies[i].ambient, mass, registered, registered.find(bodies[i]));
    result.back()->body = bodies[i];
  }
  return result;
}

using Links = std::vector<std::unique_ptr<AmbientLink>>;

std::vector<Links> makeAllLinks(const WorldState& state, btDynamicsWorld& world,
                                AmbientBodies& registered) {
  const std::vector<btMultiBody*> bodies = multiBodiesOf(world);
  std::vector<Links> result;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    result.push_back(makeLinks(state.multi_bodies[i], *bodies[i], registered));
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

btSequentialImpulseConstraintSolver* shufflingSolver(btDynamicsWorld& world) {
  return dynamic_cast<btSequentialImpulseConstraintSolver*>(world.getConstraintSolver());
}

}  // namespace

WorldState saveState(const btDynamicsWorld& world, const AmbientBodies& registered) {
  // Bullet's accessors are not const.
  auto& source = const_cast<btDynamicsWorld&>(world);
  WorldState state;
  for (const btRigidBody* body : rigidBodiesOf(source)) {
    state.bodies.push_back(fromBullet<BodyState>(*body));
    if (const AmbientBody* ambient = registered.find(body)) {
      state.bodies.back().ambient = saveAmbient(*ambient, inverseMassOf(*body));
    }
  }
  for (btMultiBody* body : multiBodiesOf(source)) {
    state.multi_bodies.push_back(saveMultiBody(*body));
    if (const AmbientTree* tree = registered.trees.find(body))
      saveFluids(*tree, state.multi_bodies.back());
  }
  for (btMultiBodyConstraint* joint : multiBodyJointsOf(source))
    state.multi_body_joints.push_back(saveJoint(*joint));
  state.pairs = savePairs(source);
  state.contacts = saveContacts(source);
  saveBoxes(source, state);
  for (int i = 0; i < source.getNumConstraints(); ++i)
    state.joints.push_back(fromBullet<JointState>(*source.getConstraint(i)));
  state.time = registered.regions.time;
  if (const auto* solver = shufflingSolver(source)) state.random_seed = solver->getRandSeed();
  return state;
}

void restoreState(const WorldState& state, btDynamicsWorld& world, AmbientBodies& registered) {
  registered.requireChangeable("restoreState");
  const std::vector<btRigidBody*> bodies = rigidBodiesOf(world);
  check(state, world);
  auto ambient_bodies = makeAmbientBodies(state, bodies, registered);
  std::vector<Links> links = makeAllLinks(state, world, registered);

  for (std::size_t i = 0; i < bodies.size(); ++i) {
    restoreMass(state.bodies[i], *bodies[i]);
    restoreBody(state.bodies[i], *bodies[i]);
    if (ambient_bodies[i]) {
      AmbientBody& ambient = registered.insert(std::move(*ambient_bodies[i]));
      if (ambient.vessel) floatAgain(ambient, readState(*bodies[i]), registered.regions);
    } else {
      registered.erase(*bodies[i]);
    }
  }
  restoreMultiBodies(state, std::move(links), world, registered);
  registered.regions.time = state.time;
  for (int i = 0; i < world.getNumConstraints(); ++i)
    toBullet(state.joints[static_cast<std::size_t>(i)], *world.getConstraint(i));
  restoreContacts(state, world);
  for (std::size_t i = 0; i < bodies.size(); ++i) restoreSleep(state.bodies[i], *bodies[i]);
  const std::vector<btMultiBody*> multi_bodies = multiBodiesOf(world);
  for (std::size_t i = 0; i < multi_bodies.size(); ++i)
    restoreSleep(state.multi_bodies[i], *multi_bodies[i]);
  if (auto* solver = shufflingSolver(world))
    solver->setRandSeed(static_cast<unsigned long>(state.random_seed));
}

AMBIENT_END
