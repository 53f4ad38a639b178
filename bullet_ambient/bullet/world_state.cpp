#include "bullet_ambient/bullet/world_state.h"

#include <BulletDynamics/ConstraintSolver/btSequentialImpulseConstraintSolver.h>
#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Dynamics/btDynamicsWorld.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "bullet_ambient/bullet/ambient_bodies.h"
#include "bullet_ambient/bullet/ambient_registry.h"
#include "bullet_ambient/bullet/body_state.h"
#include "bullet_ambient/bullet/contact_state.h"
#include "bullet_ambient/bullet/region_following.h"
#include "bullet_ambient/bullet/world_objects.h"
#include "bullet_ambient/bullet/world_state_faults.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

AmbientState saveAmbient(const AmbientBody& ambient) {
  AmbientState state{ambient.def,    ambient.medium,          ambient.place,
                     ambient.memory, ambient.encounter.waves, ambient.encounter.met_B,
                     ambient.left_W, ambient.counters};
  if (isModelStale(ambient)) state.memory = {};  // as the next step will do
  return state;
}

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

// Models are built before anything is changed, so that a medium that is refused changes nothing.
std::vector<std::unique_ptr<AmbientBody>> makeAmbientBodies(const WorldState& state,
                                                            const std::vector<btRigidBody*>& bodies,
                                                            AmbientBodies& registered) {
  std::vector<std::unique_ptr<AmbientBody>> result;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    result.emplace_back();
    if (!state.bodies[i].ambient) continue;
    const AmbientState& saved = *state.bodies[i].ambient;
    if (!saved.def.fluid_body) {
      throw std::invalid_argument("restoreState: an attached body of the state has no fluid body");
    }
    btRigidBody with_mass(1, nullptr, bodies[i]->getCollisionShape());
    restoreMass(state.bodies[i], with_mass);
    AmbientBody built;
    built.body = &with_mass;
    built.def = saved.def;
    refreshModel(built, registered.regions, registered.load_tables);
    // Of a region that is not here, the next step tells.
    if (enterMedium(built, saved.place, saved.medium) && isModelStale(built) &&
        with_mass.getInvMass() > 0)
      rebuildModel(built);
    result.back() = std::make_unique<AmbientBody>(built);
    AmbientBody& ambient = *result.back();
    ambient.body = bodies[i];
    ambient.memory = saved.memory;
    ambient.encounter.waves = saved.waves;
    ambient.encounter.met_B = saved.met_B;
    ambient.left_W = saved.left_W;
    ambient.counters = saved.counters;
  }
  return result;
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
  const std::vector<btRigidBody*> bodies = rigidBodiesOf(world);
  checkCount("rigid bodies", state.bodies.size(), bodies.size());
  checkCount("joints", state.joints.size(), static_cast<std::size_t>(world.getNumConstraints()));
  checkNumbers(state);
  auto ambient_bodies = makeAmbientBodies(state, bodies, bodiesOf(registry));

  for (std::size_t i = 0; i < bodies.size(); ++i) {
    registry.detach(*bodies[i]);
    restoreMass(state.bodies[i], *bodies[i]);
    restoreBody(state.bodies[i], *bodies[i]);
    if (ambient_bodies[i]) bodiesOf(registry).insert(std::move(ambient_bodies[i]));
  }
  bodiesOf(registry).regions.time = state.time;
  restoreJoints(state, world);
  restoreContacts(state.pairs, state.contacts, world);
  for (std::size_t i = 0; i < bodies.size(); ++i) restoreSleep(state.bodies[i], *bodies[i]);
  if (auto* solver = shufflingSolver(world)) solver->setRandSeed(state.random_seed);
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
