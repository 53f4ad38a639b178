#include "bullet_ambient/bullet/world_state_faults.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "bullet_ambient/bullet/conversions.h"

namespace ambient {
inline namespace BULLET_AMBIENT_PRECISION_NAMESPACE {
namespace {

bool areFinite(std::initializer_list<btVector3> vectors) {
  for (const btVector3& v : vectors)
    if (!toVector3(v).allFinite()) return false;
  return true;
}

bool areFinite(std::initializer_list<btScalar> numbers) {
  for (const btScalar number : numbers)
    if (!std::isfinite(number)) return false;
  return true;
}

bool isFinite(const btTransform& pose) {
  const btMatrix3x3& axes = pose.getBasis();
  return areFinite({pose.getOrigin(), axes[0], axes[1], axes[2]});
}

template <class Numbers>
bool areAllFinite(const Numbers& numbers) {
  return std::all_of(numbers.begin(), numbers.end(),
                     [](btScalar number) { return std::isfinite(number); });
}

bool isTurn(const btQuaternion& q) { return std::abs(q.length2() - 1) < btScalar(0.01); }

bool isPart(btScalar number) { return number >= 0 && number <= 1; }

std::string faultOfObject(const ObjectState& object) {
  if (!isFinite(object.pose) || !isFinite(object.interpolation_pose) ||
      !areFinite({object.interpolation_linear_velocity, object.interpolation_angular_velocity}))
    return "pose or velocity is not finite";
  if (object.activation_state < ACTIVE_TAG || object.activation_state > FIXED_BASE_MULTI_BODY)
    return "activation state is unknown: " + std::to_string(object.activation_state);
  if (!areFinite(
          {object.friction, object.rolling_friction, object.spinning_friction, object.restitution}))
    return "friction or restitution is not finite";
  // Some of these are infinite where a program says "never".
  for (const btScalar number : {object.ccd_radius, object.ccd_threshold,
                                object.contact_processing_threshold, object.deactivation_time})
    if (std::isnan(number)) return "threshold of sleep or collision is not a number";
  return {};
}

std::string faultOfMotion(const BodyState& body) {
  if (!areFinite({body.linear_velocity, body.angular_velocity}))
    return "pose or velocity is not finite";
  if (!areFinite({body.total_force, body.total_torque, body.gravity}))
    return "force, torque or gravity is not finite";
  return {};
}

std::string faultOfProperties(const BodyState& body) {
  const btVector3& inertia = body.inverse_inertia;
  if (!(body.inverse_mass >= 0) || !std::isfinite(body.inverse_mass))
    return "inverse mass is negative or not finite: " + std::to_string(body.inverse_mass);
  if (!areFinite({inertia}) || !(inertia[inertia.minAxis()] >= 0))
    return "inverse inertia is negative or not finite";
  if (!areFinite({body.linear_factor, body.angular_factor}))
    return "linear or angular factor is not finite";
  if (!isPart(body.linear_damping) || !isPart(body.angular_damping))
    return "damping is not between 0 and 1";
  for (const btScalar number : {body.linear_sleeping_threshold, body.angular_sleeping_threshold})
    if (std::isnan(number)) return "threshold of sleep or collision is not a number";
  return {};
}

// Flights take energies of them.
template <class Vector>
bool hasFiniteSquare(const Vector& v) {
  return std::isfinite(v.squaredNorm());
}

bool isNatural(double number) { return number >= 0 && std::isfinite(number); }

bool isPhysical(const WaveMemory& waves) {
  return hasFiniteSquare(waves.tilt_W[0]) && hasFiniteSquare(waves.tilt_W[1]) &&
         std::isfinite(waves.heave[0] * waves.heave[0]) &&
         std::isfinite(waves.heave[1] * waves.heave[1]) && isNatural(waves.heave_energy) &&
         isNatural(waves.tilt_energy) && std::isfinite(waves.energy());
}

bool isPhysical(const SurfacePlane& plane) {
  return std::abs(plane.normal.squaredNorm() - 1) < 0.01 && std::isfinite(plane.height) &&
         isNatural(plane.density) && isNatural(plane.gravity);
}

std::string faultOfFlight(const AmbientState& ambient) {
  const FlightMemory& memory = ambient.memory;
  if (!hasFiniteSquare(memory.load_W.vector()) || !hasFiniteSquare(ambient.left_W.vector()))
    return "flight has a load or velocity that is not finite, or its square is not";
  if (!isNatural(memory.substep))
    return "flight has a substep that is negative or not finite: " + std::to_string(memory.substep);
  if (!isPhysical(ambient.waves))
    return "waves have energies that are negative or not finite, or heights that have such";
  if (ambient.met_B && !isPhysical(*ambient.met_B))
    return "surface of the water is not finite, or its normal is no direction";
  const Medium& medium = ambient.medium;
  if (!(medium.density >= 0) || !(medium.viscosity >= 0) || !std::isfinite(medium.density) ||
      !std::isfinite(medium.viscosity) || !medium.velocity.allFinite() ||
      !medium.acceleration.allFinite())
    return "medium is not physical";
  return {};
}

std::string faultOf(const BodyState& body) {
  std::string fault = faultOfObject(body);
  if (fault.empty()) fault = faultOfMotion(body);
  if (fault.empty()) fault = faultOfProperties(body);
  if (fault.empty() && body.ambient) fault = faultOfFlight(*body.ambient);
  return fault;
}

std::string faultOf(const MultiBodyLinkState& link) {
  if (!(link.mass >= 0) || !std::isfinite(link.mass))
    return "mass is negative or not finite: " + std::to_string(link.mass);
  if (!areFinite({link.inertia}) || !(link.inertia[link.inertia.minAxis()] >= 0))
    return "inertia is negative or not finite";
  if (!isFinite(link.pose) || !areAllFinite(link.joint_position) ||
      !areAllFinite(link.interpolation_position))
    return "pose or position of its joint is not finite";
  if (!areFinite({link.force, link.torque}) || !areAllFinite(link.joint_force))
    return "force or torque is not finite";
  return link.collider ? faultOfObject(*link.collider) : std::string();
}

std::string faultOfBase(const MultiBodyState& body) {
  if (body.links.empty()) return "base is missing";
  if (!areFinite({body.position, body.interpolation_position}) || !areAllFinite(body.velocity))
    return "pose or velocity is not finite";
  if (!isTurn(body.orientation) || !isTurn(body.interpolation_orientation))
    return "orientation is no quaternion of unit length";
  if (!areFinite({body.linear_damping, body.angular_damping}) || !(body.linear_damping >= 0) ||
      !(body.angular_damping >= 0))
    return "damping is negative or not finite";
  if (!(body.velocity_limit >= 0)) return "limit of velocity is negative or not a number";
  if (std::isnan(body.sleep_timer) || std::isnan(body.sleep_threshold) ||
      std::isnan(body.sleep_timeout))
    return "threshold or time of sleep is not a number";
  if (!(body.turn_reserve >= 0) || !std::isfinite(body.turn_reserve))
    return "reserve of energy is negative or not finite";
  return {};
}

std::string faultOf(const MultiBodyState& body) {
  const std::string fault = faultOfBase(body);
  if (!fault.empty()) return fault;
  for (std::size_t i = 0; i < body.links.size(); ++i) {
    const std::string of_link = faultOf(body.links[i]);
    if (!of_link.empty()) return "link " + std::to_string(static_cast<int>(i) - 1) + ": " + of_link;
  }
  for (const LinkFluidState& fluid : body.fluids) {
    if (fluid.flow && !fluid.flow->allFinite()) return "flow around a link is not finite";
    const std::string of_fluid = faultOfFlight(fluid.ambient);
    if (!of_fluid.empty()) return of_fluid;
  }
  return {};
}

// Bullet leaves directions of friction unset until rows are made.
bool isPhysical(const btManifoldPoint& p) {
  const bool has_directions = p.m_contactPointFlags & BT_CONTACT_FLAG_LATERAL_FRICTION_INITIALIZED;
  return areFinite({p.m_localPointA, p.m_localPointB, p.m_positionWorldOnA, p.m_positionWorldOnB,
                    p.m_normalWorldOnB}) &&
         (!has_directions || areFinite({p.m_lateralFrictionDir1, p.m_lateralFrictionDir2})) &&
         areFinite({p.m_distance1, p.m_combinedFriction, p.m_combinedRollingFriction,
                    p.m_combinedSpinningFriction, p.m_combinedRestitution, p.m_appliedImpulse,
                    p.m_contactMotion1, p.m_contactMotion2, p.m_contactCFM, p.m_contactERP,
                    p.m_frictionCFM}) &&
         p.m_normalWorldOnB.length2() < 2;
}

std::string faultOf(const ContactState& contact) {
  const std::size_t points = contact.points.size();
  if (contact.pair.object_a < 0 || contact.pair.object_b < 0)
    return "has a contact without an object";
  if (points > MANIFOLD_CACHE_SIZE)
    return "has a contact of " + std::to_string(points) + " points; at most " +
           std::to_string(MANIFOLD_CACHE_SIZE) + " are possible";
  for (const btManifoldPoint& point : contact.points)
    if (!isPhysical(point))
      return "has a contact point whose numbers are not finite, or whose normal is no direction";
  return {};
}

}  // namespace

std::string findFault(const WorldState& state) {
  for (std::size_t i = 0; i < state.bodies.size(); ++i) {
    const std::string fault = faultOf(state.bodies[i]);
    if (!fault.empty()) return "has a body, number " + std::to_string(i) + ", whose " + fault;
  }
  for (std::size_t i = 0; i < state.multi_bodies.size(); ++i) {
    const std::string fault = faultOf(state.multi_bodies[i]);
    if (!fault.empty()) return "has a multibody, number " + std::to_string(i) + ", whose " + fault;
  }
  for (const MultiBodyJointState& joint : state.multi_body_joints)
    if (!areAllFinite(joint.applied_impulses)) return "has a joint whose impulse is not finite";
  for (const PairState& pair : state.pairs)
    if (pair.object_a < 0 || pair.object_b < 0) return "has a contact without an object";
  for (const ContactState& contact : state.contacts) {
    const std::string fault = faultOf(contact);
    if (!fault.empty()) return fault;
  }
  for (const JointState& joint : state.joints)
    if (!std::isfinite(joint.applied_impulse)) return "has a joint whose impulse is not finite";
  if (!std::isfinite(state.time)) return "has a time that is not finite";
  return {};
}

}  // namespace BULLET_AMBIENT_PRECISION_NAMESPACE
}  // namespace ambient
