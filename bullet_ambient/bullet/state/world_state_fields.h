#pragma once

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>

#include <cmath>
#include <functional>
#include <string>
#include <type_traits>

#include "bullet_ambient/bullet/core/precision_check.h"
#include "bullet_ambient/bullet/state/world_state_structs.h"
#include "bullet_ambient/force/medium/medium.h"

AMBIENT_BEGIN

// Getters and setters of stored fields in Bullet's objects, where Bullet has no pair of
// functions for one.

/// Selects the const overload of a getter.
template <class Result, class Object>
constexpr auto constant(Result (Object::*get)() const) {
  return get;
}

/// Setter of a field that is restored together with others, by the named function; does nothing.
struct SetElsewhere {
  template <class Object, class Field>
  void operator()(Object&, const Field&) const {}
};
constexpr SetElsewhere kByRestoreMass{}, kByRestoreForces{}, kByRestoreSleep{};

// All stored fields, listed once for all operations: write, read, check, copy from Bullet and back
// to Bullet. Their order is that of the bytes. To add a field, add it to the structure and here,
// and raise the version.
constexpr std::uint32_t kStateVersion = 19;

/// Condition that each number of a field must meet, and the words of the message if one does not.
/// The message begins with the name of the object; the value follows if the words end with a blank.
struct Rule {
  bool (*holds)(double) = nullptr;  ///< null: no condition
  const char* fault = "";
};
constexpr Rule kAny;
constexpr Rule finite(const char* fault) {
  return {[](double x) { return std::isfinite(x); }, fault};
}
constexpr Rule finiteNotNegative(const char* fault) {
  return {[](double x) { return x >= 0 && std::isfinite(x); }, fault};
}
constexpr Rule notNegative(const char* fault) {
  return {[](double x) { return x >= 0; }, fault};
}
constexpr Rule share(const char* fault) {
  return {[](double x) { return x >= 0 && x <= 1; }, fault};
}
/// Bullet's thresholds are infinite where a program says "never".
constexpr Rule number(const char* fault) {
  return {[](double x) { return !std::isnan(x); }, fault};
}

/// Base of visitors of fields; does nothing. A visitor defines v(field, rule), and v(field, rule,
/// get, set) with getter and setter of Bullet's object.
struct FieldVisitor {
  /// Visits an enumerator; `names`: table of the valid ones.
  template <class Enum, class Names>
  void choice(Enum&, const Names&) {}
  void fluidBody(std::shared_ptr<const FluidBody>&) {}
  /// Visits a structure that may be absent.
  template <class State>
  void optional(std::optional<State>&) {}
  /// Visits a list of structures; name(index) begins the messages about an entry.
  template <class State, class Name>
  void list(std::vector<State>&, const Name&) {}
  /// Checks a condition on several fields together.
  template <class Words, class Holds>
  void check(const Words&, const Holds&) {}
};

/// Visits fields without names that have one rule.
template <class V, class... Field>
void each(V& v, const Rule& rule, Field&... field) {
  (v(field, rule), ...);
}

constexpr auto kNoName = [](std::size_t) { return std::string(); };
inline auto numbered(const char* words) {
  return [words](std::size_t i) { return words + std::to_string(i) + ", whose "; };
}

template <class V>
void fields(V& v, Medium& s) {
  each(v, kAny, s.density, s.viscosity, s.velocity, s.acceleration);
}

// checkDef() and makeBodyModel() tell what is wrong with these.
template <class V>
void fields(V& v, AttachDef& s) {
  v.fluidBody(s.fluid_body);
  fields(v, s.medium);
  each(v, kAny, s.follow_regions, s.wave_damping, s.added_mass_factor, s.load_factor,
       s.flow.separation_angle, s.flow.roughness);
  v.choice(s.flow.law, kPressureLawNames);
  each(v, kAny, s.flow.skin_friction, s.flow.stall_lag);
  v.choice(s.flow.precision, kLoadPrecisionNames);
  each(v, kAny, s.flow.maximum_load_error);
  each(v, kAny, s.flight.tolerance, s.flight.max_substeps, s.fluid_frame.rotation,
       s.fluid_frame.translation, s.holds.are_open, s.holds.atmosphere, s.holds.sloshing_damping);
}

template <class V>
void fields(V& v, VectorsOf<double>& s) {
  each(v, kAny, s.x, s.y, s.z);
}

template <class V>
void fields(V& v, WaveMemory& s) {
  each(v, kAny, s.heave.first);
  fields(v, s.tilt_W[0]);
  each(v, kAny, s.heave.second);
  fields(v, s.tilt_W[1]);
  each(v, kAny, s.heave_energy, s.tilt_energy);
  v.check("waves have energies that are negative or not finite, or heights that have such", [&s] {
    double squares = s.heave.first * s.heave.first + s.heave.second * s.heave.second;
    for (const VectorsOf<double>& tilt : s.tilt_W)
      squares += tilt.x * tilt.x + tilt.y * tilt.y + tilt.z * tilt.z;
    return s.heave_energy >= 0 && s.tilt_energy >= 0 && std::isfinite(s.energy()) &&
           std::isfinite(squares);
  });
}

template <class V>
void fields(V& v, SurfacePlane& s) {
  constexpr auto kFault = "surface of the water is not finite, or its normal is no direction";
  v(s.normal, kAny);
  v(s.height, finite(kFault));
  each(v, finiteNotNegative(kFault), s.density, s.gravity);
  v.check(kFault, [&s] { return std::abs(s.normal.squaredNorm() - 1) < 0.01; });
}

template <class V>
void fields(V& v, AmbientCounters& s) {
  each(v, kAny, s.substeps, s.load_evaluations, s.faces, s.guarded, s.coarse, s.halted,
       s.energy_removed, s.rows, s.joint_rows, s.rejected, s.regions_asked, s.medium_changes,
       s.too_long);
}

template <class V>
void fields(V& v, HoldState& s) {
  v(s.volume, finiteNotNegative("hold has a volume of water that is negative or not finite: "));
  v(s.pump, finite("hold has a pump whose rate is not finite: "));
  v(s.air, finiteNotNegative("hold has sealed air that is negative or not finite: "));
  each(v, kAny, s.flooded, s.drained, s.is_sealed);
}

template <class V>
void fields(V& v, Sloshing& s) {
  each(v, kAny, s.is_known);
  each(v, finite("hold has water that sloshes without a finite way and velocity"), s.displacement_W,
       s.velocity_W);
}

template <class V>
void fields(V& v, AddedHole& s) {
  each(v, kAny, s.hold);
  v(s.area, finiteNotNegative("hold has a hole whose area is negative or not finite: "));
  each(v, finite("hold has a hole whose place or normal is not finite"), s.place, s.normal);
  constexpr const char* kFault = "hold has a hole without an area or a normal of length 1";
  v.check(kFault, [&s] { return s.area > 0 && std::abs(s.normal.squaredNorm() - 1) < 1e-9; });
}

/// Whether an opening is shut.
template <class V>
void fields(V& v, std::uint8_t& s) {
  v(s, kAny);
}

template <class V>
void fields(V& v, AmbientState& s) {
  fields(v, s.def);
  fields(v, s.medium);
  v.check("medium is not physical", [&m = s.medium] { return !faultOf(m); });
  each(v, kAny, s.location.region, s.location.is_above, s.location.is_at_surface);
  each(v, kAny, s.flow.until, s.flow.position, s.flow.velocity, s.flow.change, s.flow.parts,
       s.flow.region, s.flow.is_above);
  v.check("fluid has had a place, velocity or change that is not finite", [&f = s.flow] {
    return f.position.allFinite() && f.velocity.allFinite() && f.change.allFinite();
  });
  fields(v, s.waves);
  v.optional(s.plane_B);
  each(v, kAny, s.memory.load_W.torque, s.memory.load_W.force, s.memory.has_load);
  each(v, finiteNotNegative("growth of a resistance is negative or not finite: "),
       s.memory.growth.rotation, s.memory.growth.translation);
  v(s.memory.substep, finiteNotNegative("flight has a substep that is negative or not finite: "));
  each(v, kAny, s.wake.velocity_W.angular, s.wake.velocity_W.linear, s.wake.has_begun);
  each(v, kAny, s.has_met_water, s.has_sunk);
  v.list(s.holds, kNoName);
  v.list(s.sloshing, kNoName);
  v.list(s.is_shut, kNoName);
  v.list(s.holes, kNoName);
  each(v, kAny, s.left_W.angular, s.left_W.linear);
  // Flights take energies of both.
  v.check("flight has a load or velocity that is not finite, or its square is not", [&s] {
    return std::isfinite(s.memory.load_W.vector().squaredNorm()) &&
           std::isfinite(s.wake.velocity_W.vector().squaredNorm()) &&
           std::isfinite(s.left_W.vector().squaredNorm());
  });
  fields(v, s.counters);
}

template <class V>
void fields(V& v, ObjectState& s) {
  using Object = btCollisionObject;
  constexpr Rule kMotion = finite("pose or velocity is not finite");
  constexpr Rule kContact = finite("friction or restitution is not finite");
  constexpr Rule kThreshold = number("threshold of sleep or collision is not a number");
  constexpr Rule kActivation{[](double x) { return x >= ACTIVE_TAG && x <= FIXED_BASE_MULTI_BODY; },
                             "activation state is unknown: "};
  v(s.pose, kMotion, constant(&Object::getWorldTransform), &Object::setWorldTransform);
  v(s.interpolation_pose, kMotion, constant(&Object::getInterpolationWorldTransform),
    &Object::setInterpolationWorldTransform);
  v(s.interpolation_linear_velocity, kMotion, &Object::getInterpolationLinearVelocity,
    &Object::setInterpolationLinearVelocity);
  v(s.interpolation_angular_velocity, kMotion, &Object::getInterpolationAngularVelocity,
    &Object::setInterpolationAngularVelocity);
  v(s.friction, kContact, &Object::getFriction, &Object::setFriction);
  v(s.rolling_friction, kContact, &Object::getRollingFriction, &Object::setRollingFriction);
  v(s.spinning_friction, kContact, &Object::getSpinningFriction, &Object::setSpinningFriction);
  v(s.restitution, kContact, &Object::getRestitution, &Object::setRestitution);
  v(s.ccd_radius, kThreshold, &Object::getCcdSweptSphereRadius, &Object::setCcdSweptSphereRadius);
  v(s.ccd_threshold, kThreshold, &Object::getCcdMotionThreshold, &Object::setCcdMotionThreshold);
  v(s.contact_processing_threshold, kThreshold, &Object::getContactProcessingThreshold,
    &Object::setContactProcessingThreshold);
  v(s.deactivation_time, kThreshold, &Object::getDeactivationTime, kByRestoreSleep);
  v(s.activation_state, kActivation, &Object::getActivationState, kByRestoreSleep);
  v(s.collision_flags, kAny, &Object::getCollisionFlags, &Object::setCollisionFlags);
}

template <class V>
void fields(V& v, BodyState& s) {
  using Body = btRigidBody;
  constexpr Rule kMotion = finite("pose or velocity is not finite");
  constexpr Rule kForce = finite("force, torque or gravity is not finite");
  constexpr Rule kInertia = finiteNotNegative("inverse inertia is negative or not finite");
  constexpr Rule kFactor = finite("linear or angular factor is not finite");
  constexpr Rule kMass = finiteNotNegative("inverse mass is negative or not finite: ");
  constexpr Rule kDamping = share("damping is not between 0 and 1");
  constexpr Rule kThreshold = number("threshold of sleep or collision is not a number");
  fields(v, static_cast<ObjectState&>(s));
  v(s.linear_velocity, kMotion, &Body::getLinearVelocity, &Body::setLinearVelocity);
  v(s.angular_velocity, kMotion, &Body::getAngularVelocity, &Body::setAngularVelocity);
  v(s.total_force, kForce, &Body::getTotalForce, kByRestoreForces);
  v(s.total_torque, kForce, &Body::getTotalTorque, kByRestoreForces);
  v(s.gravity, kForce, &Body::getGravity, kByRestoreMass);
  v(s.inverse_inertia, kInertia, &Body::getInvInertiaDiagLocal, kByRestoreMass);
  v(s.linear_factor, kFactor, &Body::getLinearFactor, kByRestoreForces);
  v(s.angular_factor, kFactor, &Body::getAngularFactor, kByRestoreForces);
  v(s.inverse_mass, kMass, &Body::getInvMass, kByRestoreMass);
  v(s.linear_damping, kDamping, &Body::getLinearDamping,
    [](Body& b, btScalar x) { b.setDamping(x, b.getAngularDamping()); });
  v(s.angular_damping, kDamping, &Body::getAngularDamping,
    [](Body& b, btScalar x) { b.setDamping(b.getLinearDamping(), x); });
  v(s.linear_sleeping_threshold, kThreshold, &Body::getLinearSleepingThreshold,
    [](Body& b, btScalar x) { b.setSleepingThresholds(x, b.getAngularSleepingThreshold()); });
  v(s.angular_sleeping_threshold, kThreshold, &Body::getAngularSleepingThreshold,
    [](Body& b, btScalar x) { b.setSleepingThresholds(b.getLinearSleepingThreshold(), x); });
  v(s.flags, kAny, &Body::getFlags, &Body::setFlags);
  v.optional(s.ambient);
}

// saveMultiBody() and restoreMultiBody() pass these between Bullet's links and their states.
template <class V>
void fields(V& v, MultiBodyLinkState& s) {
  constexpr Rule kForce = finite("force or torque is not finite");
  constexpr Rule kPosition = finite("pose or position of its joint is not finite");
  v(s.mass, finiteNotNegative("mass is negative or not finite: "));
  v(s.inertia, finiteNotNegative("inertia is negative or not finite"));
  each(v, kForce, s.force, s.torque);
  v(s.joint_position, kPosition);
  v(s.joint_force, kForce);
  v(s.turn_in_parent, kPosition);
  v.check("turn of its joint is no quaternion of unit length",
          [&s] { return std::abs(s.turn_in_parent.length2() - 1) < btScalar(0.01); });
  each(v, kPosition, s.way_from_parent, s.pose);
  v.optional(s.collider);
}

template <class V>
void fields(V& v, LinkFluidState& s) {
  v(s.link, kAny);
  fields(v, s.ambient);
}

template <class V>
void fields(V& v, MultiBodyState& s) {
  using Body = btMultiBody;
  constexpr Rule kMotion = finite("pose or velocity is not finite");
  constexpr Rule kDamping = finiteNotNegative("damping is negative or not finite");
  constexpr Rule kLimit = notNegative("limit of velocity is negative or not a number");
  constexpr Rule kSleep = number("threshold or time of sleep is not a number");
  v.check("base is missing", [&s] { return !s.links.empty(); });
  v(s.position, kMotion, &Body::getBasePos, &Body::setBasePos);
  v(s.interpolation_position, kMotion, &Body::getInterpolateBasePos, &Body::setInterpolateBasePos);
  v(s.orientation, kAny, &Body::getWorldToBaseRot, &Body::setWorldToBaseRot);
  v(s.interpolation_orientation, kAny, &Body::getInterpolateWorldToBaseRot,
    &Body::setInterpolateWorldToBaseRot);
  v.check("orientation is no quaternion of unit length", [&s] {
    return std::abs(s.orientation.length2() - 1) < btScalar(0.01) &&
           std::abs(s.interpolation_orientation.length2() - 1) < btScalar(0.01);
  });
  v(s.velocity, kMotion);
  v.list(s.links,
         [](std::size_t i) { return "link " + std::to_string(static_cast<int>(i) - 1) + ": "; });
  v(s.linear_damping, kDamping, &Body::getLinearDamping, &Body::setLinearDamping);
  v(s.angular_damping, kDamping, &Body::getAngularDamping, &Body::setAngularDamping);
  v(s.velocity_limit, kLimit, &Body::getMaxCoordinateVelocity, &Body::setMaxCoordinateVelocity);
  each(v, kSleep, s.sleep_timer, s.sleep_threshold, s.sleep_timeout);
  v(s.is_awake, kAny, &Body::isAwake, kByRestoreSleep);
  v(s.can_sleep, kAny, &Body::getCanSleep, kByRestoreSleep);
  v(s.can_wake_up, kAny, &Body::getCanWakeup, kByRestoreSleep);
  v(s.has_gyroscopic_term, kAny, &Body::getUseGyroTerm, &Body::setUseGyroTerm);
  v(s.turn_reserve, finiteNotNegative("reserve of energy is negative or not finite"));
  v.list(s.fluids, kNoName);
}

template <class V>
void fields(V& v, btManifoldPoint& s) {
  constexpr auto kFault =
      "has a contact point whose numbers are not finite, or whose normal is no direction";
  each(v, finite(kFault), s.m_localPointA, s.m_localPointB, s.m_positionWorldOnB,
       s.m_positionWorldOnA, s.m_normalWorldOnB);
  v.check(kFault, [&s] { return s.m_normalWorldOnB.length2() < 2; });
  each(v, kAny, s.m_lateralFrictionDir1, s.m_lateralFrictionDir2);
  each(v, finite(kFault), s.m_distance1, s.m_combinedFriction, s.m_combinedRollingFriction,
       s.m_combinedSpinningFriction, s.m_combinedRestitution, s.m_appliedImpulse);
  each(v, kAny, s.m_prevRHS, s.m_appliedImpulseLateral1, s.m_appliedImpulseLateral2);
  each(v, finite(kFault), s.m_contactMotion1, s.m_contactMotion2, s.m_contactCFM, s.m_contactERP,
       s.m_frictionCFM);
  each(v, kAny, s.m_partId0, s.m_partId1, s.m_index0, s.m_index1, s.m_contactPointFlags,
       s.m_lifeTime);
  // Bullet leaves directions of friction unset until rows are made.
  v.check(kFault, [&s] {
    return !(s.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED) ||
           std::isfinite(s.m_lateralFrictionDir1.length2() + s.m_lateralFrictionDir2.length2());
  });
}

template <class V>
void fields(V& v, PairState& s) {
  each(v, notNegative("has a contact without an object"), s.object_a, s.object_b);
}

template <class V>
void fields(V& v, BoxState& s) {
  each(v, finite("has a bounding box that is not finite"), s.smallest, s.largest, s.leaf_smallest,
       s.leaf_largest);
}

template <class V>
void fields(V& v, ContactState& s) {
  fields(v, s.pair);
  v(s.part, kAny);
  v.check("has a contact of " + std::to_string(s.points.size()) + " points; at most " +
              std::to_string(MANIFOLD_CACHE_SIZE) + " are possible",
          [&s] { return s.points.size() <= MANIFOLD_CACHE_SIZE; });
  v.list(s.points, kNoName);
}

template <class V>
void fields(V& v, JointState& s) {
  using Joint = btTypedConstraint;
  v(s.is_enabled, kAny, &Joint::isEnabled, &Joint::setEnabled);
  v(s.applied_impulse, finite("has a joint whose impulse is not finite"),
    &Joint::internalGetAppliedImpulse, &Joint::internalSetAppliedImpulse);
}

template <class V>
void fields(V& v, MultiBodyJointState& s) {
  v(s.applied_impulses, finite("has a joint whose impulse is not finite"));
}

template <class V>
void fields(V& v, WorldState& s) {
  v.list(s.bodies, numbered("has a body, number "));
  v.list(s.multi_bodies, numbered("has a multibody, number "));
  v.list(s.pairs, kNoName);
  v.list(s.contacts, kNoName);
  v.list(s.boxes, kNoName);
  each(v, notNegative("has pairs whose number is negative"), s.next_pair, s.new_pairs);
  v(s.looks_at_pairs, kAny);
  v.list(s.joints, kNoName);
  v.list(s.multi_body_joints, kNoName);
  v(s.random_seed, kAny);
  v(s.time, finite("has a time that is not finite"));
}

/// Shows the fields of a state to a visitor that changes nothing.
template <class V, class State>
void visit(V& v, const State& s) {
  fields(v, const_cast<State&>(s));
}

AMBIENT_END
