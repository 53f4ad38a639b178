#pragma once

#include <BulletCollision/NarrowPhaseCollision/btPersistentManifold.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/force/medium/fluid_region.h"
#include "bullet_ambient/force/medium/surface_plane.h"
#include "bullet_ambient/immersed/attach_def.h"
#include "bullet_ambient/motion/body/body_model.h"
#include "bullet_ambient/motion/flight/flight.h"
#include "bullet_ambient/motion/lanes/surface_lanes.h"
#include "bullet_ambient/motion/surface/hold_water.h"

AMBIENT_BEGIN

// Content of a saved state. world_state_fields.h lists each field once more.

/// A body in its fluid, with the memory of its flight.
struct AmbientState {
  AttachDef def;
  Medium medium;  ///< medium around the body now
  RegionLocation location;
  FlowMemory flow;
  FlightMemory memory;
  WaveMemory waves;
  std::optional<SurfacePlane> plane_B;  ///< lastPlane()
  Wake wake;
  bool has_met_water = false;         ///< VesselState::is_known
  bool has_sunk = false;              ///< VesselState::has_sunk
  std::vector<HoldState> holds;       ///< as in FluidBody::holds
  std::vector<Sloshing> sloshing;     ///< VesselSloshing::now
  std::vector<std::uint8_t> is_shut;  ///< OpeningChanges::is_shut
  std::vector<AddedHole> holes;       ///< OpeningChanges::holes
  Twist left_W;
  AmbientCounters counters;
};

/// A btCollisionObject: pose, sleep, and the properties that its contacts depend on.
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
  std::array<btScalar, 7> joint_position{};   ///< as in Bullet: the last entries may be unused
  std::array<btScalar, 6> joint_force{};      ///< applied since the last step
  // Numbers that Bullet caches. The first two follow from the joint's position up to rounding.
  btQuaternion turn_in_parent = btQuaternion::getIdentity();  ///< from the parent's axes
  btVector3 way_from_parent{0, 0, 0};                         ///< in the link's axes
  btTransform pose = btTransform::getIdentity();
  std::optional<ObjectState> collider;
};

/// The fluid of a link.
struct LinkFluidState {
  int link = -1;
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
  double turn_reserve =
      0;  ///< energy lost by earlier turning corrections, docs/theory.md eq. (31a) [J]
};

/// Two objects whose bounding boxes overlap, or did: Bullet forgets them late, and until then they
/// wake each other. Objects are numbered with the rigid bodies first, each in the order of the
/// world's array.
struct PairState {
  int object_a = 0, object_b = 0;
};

/// Bounding boxes of an object in a btDbvtBroadphase, which decide on when pairs come and go.
struct BoxState {
  btVector3 smallest{0, 0, 0}, largest{0, 0, 0};            ///< that of the last step
  btVector3 leaf_smallest{0, 0, 0}, leaf_largest{0, 0, 0};  ///< with the margin of the tree
};

/// The contact points that Bullet keeps between two objects from step to step.
struct ContactState {
  PairState pair;
  int part = 0;  ///< index of the manifold of the pair: shapes of several parts have more than one
  std::vector<btManifoldPoint> points;  // at most MANIFOLD_CACHE_SIZE
};

struct JointState {
  bool is_enabled = true;
  btScalar applied_impulse = 0;
};

/// A btMultiBodyConstraint: a motor, a limit, a joint to another body.
struct MultiBodyJointState {
  std::vector<btScalar> applied_impulses;  ///< impulses of the rows; empty before the first step
};

/// Everything of a world of rigid bodies and multibodies that changes from step to step.
struct WorldState {
  std::vector<BodyState> bodies;  // in the order of the world's array
  std::vector<MultiBodyState> multi_bodies;
  std::vector<PairState> pairs;  // both in Bullet's order
  std::vector<ContactState> contacts;
  std::vector<BoxState> boxes;       // numbered as in PairState; none: another broadphase
  int next_pair = 0, new_pairs = 1;  ///< of btDbvtBroadphase: which pairs it looks at next
  bool looks_at_pairs = true;
  std::vector<JointState> joints;
  std::vector<MultiBodyJointState> multi_body_joints;
  double time = 0;                ///< Fluid::time() [s]
  std::uint64_t random_seed = 0;  ///< random seed of a solver that shuffles its rows
};

/// Returns the first fault of a saved state that no world can have had, as words that follow "the
/// saved state", with body or contact and value; empty if there is none. Of the fluid it checks
/// only the flight's memory: makeBodyModel() checks the rest.
std::string findFault(const WorldState& state);

AMBIENT_END
