#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bullet_ambient/bullet/attach_def.h"
#include "bullet_ambient/bullet/precision_check.h"
#include "bullet_ambient/bullet/region_id.h"
#include "bullet_ambient/force/surface_plane.h"
#include "bullet_ambient/motion/flight_memory.h"
#include "bullet_ambient/motion/wave_memory.h"

class btDynamicsWorld;

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {

class AmbientRegistry;

/// A body in its fluid, and what its flight remembers.
struct AmbientState {
  AttachDef def;
  Medium medium;  ///< around it now
  RegionPlace place;
  FlightMemory memory;
  WaveMemory waves;
  std::optional<SurfacePlane> met_B;  ///< see SurfaceEncounter
  Twist left_W;
  AmbientCounters counters;
};

/// A btCollisionObject: place, sleep, and the properties that its contacts depend on.
struct ObjectState {
  btTransform pose = btTransform::getIdentity();
  btTransform interpolation_pose = btTransform::getIdentity();
  btVector3 interpolation_linear_velocity{0, 0, 0}, interpolation_angular_velocity{0, 0, 0};
  btScalar friction = 0, rolling_friction = 0, spinning_friction = 0, restitution = 0;
  btScalar ccd_radius = 0, ccd_threshold = 0, contact_processing_threshold = 0;
  btScalar deactivation_time = 0;
  int activation_state = ACTIVE_TAG, collision_flags = 0;
};

/// A btRigidBody: motion, sleep, and the properties that its motion depends on.
struct BodyState : ObjectState {
  btVector3 linear_velocity{0, 0, 0}, angular_velocity{0, 0, 0};
  btVector3 total_force{0, 0, 0}, total_torque{0, 0, 0};  ///< applied since the last step
  btVector3 gravity{0, 0, 0}, inverse_inertia{0, 0, 0};
  btVector3 linear_factor{1, 1, 1}, angular_factor{1, 1, 1};
  btScalar inverse_mass = 0, linear_damping = 0, angular_damping = 0;
  btScalar linear_sleeping_threshold = 0, angular_sleeping_threshold = 0;
  int flags = 0;
  std::optional<AmbientState> ambient;
};

/// A link of a btMultiBody, or its base, which has no joint.
struct MultiBodyLinkState {
  btScalar mass = 0;
  btVector3 inertia{0, 0, 0};
  btVector3 force{0, 0, 0}, torque{0, 0, 0};  ///< applied since the last step, world axes
  std::array<btScalar, 7> joint_position{};   ///< as Bullet has it: the last ones may be unused
  std::array<btScalar, 7> interpolation_position{};
  std::array<btScalar, 6> joint_force{};          ///< applied since the last step
  btTransform pose = btTransform::getIdentity();  ///< as Bullet remembers it
  std::optional<ObjectState> collider;
};

/// The fluid of a link.
struct LinkFluidState {
  int link = -1;
  /// In which its last step left it, world axes [m/s]; none: it was in no fluid.
  std::optional<Vector3> flow;
  AmbientState ambient;
};

/// A btMultiBody: motion, sleep, and the properties that its motion depends on.
struct MultiBodyState {
  btVector3 position{0, 0, 0}, interpolation_position{0, 0, 0};  ///< of the base
  btQuaternion orientation = btQuaternion::getIdentity();        ///< from W to the base
  btQuaternion interpolation_orientation = btQuaternion::getIdentity();
  std::vector<btScalar> velocity;  ///< btMultiBody::getVelocityVector(), 6 and one per joint axis
  std::vector<MultiBodyLinkState> links;  ///< the base first
  btScalar linear_damping = 0, angular_damping = 0, velocity_limit = 0;
  btScalar sleep_timer = 0, sleep_threshold = 0, sleep_timeout = 0;
  bool is_awake = true, can_sleep = false, can_wake_up = true, has_gyroscopic_term = true;
  std::vector<LinkFluidState> fluids;  ///< in the order of attachment
  double turn_reserve = 0;             ///< of energy, docs/theory.md eq. (31a) [J]
};

/// Two objects whose bounding boxes overlap, or did: Bullet forgets them late, and until then they
/// wake each other. Objects are numbered with the rigid bodies first, each in the order of the
/// world's array.
struct PairState {
  int object_a = 0, object_b = 0;
};

/// The contact points that Bullet keeps between two objects from step to step.
struct ContactState {
  PairState pair;
  int part = 0;  ///< which of the pair's: shapes of several parts have more than one
  std::vector<btManifoldPoint> points;  // at most MANIFOLD_CACHE_SIZE
};

struct JointState {
  bool is_enabled = true;
  btScalar applied_impulse = 0;
};

/// A btMultiBodyConstraint: a motor, a limit, a joint to another body.
struct MultiBodyJointState {
  std::vector<btScalar> applied_impulses;  ///< of its rows; empty before its first step
};

/// Everything of a world of rigid bodies and multibodies that changes from step to step.
struct WorldState {
  std::vector<BodyState> bodies;  // in the order of the world's array
  std::vector<MultiBodyState> multi_bodies;
  std::vector<PairState> pairs;  // both in Bullet's order
  std::vector<ContactState> contacts;
  std::vector<JointState> joints;
  std::vector<MultiBodyJointState> multi_body_joints;
  double time = 0;                ///< AmbientRegistry::time() [s]
  unsigned long random_seed = 0;  ///< of a solver that shuffles its rows
};

/// Takes a picture of rigid bodies and multibodies, their fluids, contacts and joints, between two
/// steps. Changes nothing. Not in it: soft bodies, vehicles, the rest of time that stepSimulation()
/// keeps when it interpolates, and what only the program sets (shapes, parameters of joints and
/// motors, filters, additional damping).
WorldState saveState(const btDynamicsWorld& world, const AmbientRegistry& registry);

/// Puts a world back into a saved state; docs/bullet_step.md says when it then goes on bit for bit.
/// The world has the same bodies, multibodies and joints in the same order: it is the same one, or
/// was built by the same code, or loaded from a file. Attaches and detaches as needed. Runs
/// Bullet's collision detection once, with its callbacks, so that contacts have their places.
/// @throws std::invalid_argument if the numbers of bodies, links or joints differ, a number is none
/// that a world can have, a fluid body is missing or a medium is not physical; the world is then
/// unchanged.
void restoreState(const WorldState& state, btDynamicsWorld& world, AmbientRegistry& registry);

/// Fluid bodies are not part of saved bytes, which hold their names and content hashes. This finds
/// them again by name; null if there is none of that name.
using FluidBodyLookup = std::function<std::shared_ptr<const FluidBody>(const std::string& name)>;

/// A saved state as bytes: little-endian, with version, precision and checksum, the same state
/// gives the same bytes. A function in FlowSettings::own_law is not in them: set it in what
/// decodeState() returns.
/// @throws std::runtime_error if two fluid bodies of one name have different contents.
std::string encodeState(const WorldState& state);

/// The state that encodeState() was given, bit for bit; `source` stands for it in messages.
/// @throws std::runtime_error with one sentence if the bytes are foreign, cut short, damaged, of a
/// newer version or of the other precision of Bullet, or if a fluid body is not found or not the
/// one that was saved.
WorldState decodeState(std::string_view bytes, const std::string& source,
                       const FluidBodyLookup& lookup);

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
