#include "bullet_ambient/bullet/world_state_faults.h"

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

bool isPart(btScalar number) { return number >= 0 && number <= 1; }

std::string faultOfMotion(const BodyState& body) {
  if (!isFinite(body.pose) || !isFinite(body.interpolation_pose) ||
      !areFinite({body.linear_velocity, body.angular_velocity, body.interpolation_linear_velocity,
                  body.interpolation_angular_velocity}))
    return "pose or velocity is not finite";
  if (!areFinite({body.total_force, body.total_torque, body.gravity}))
    return "force, torque or gravity is not finite";
  if (body.activation_state < ACTIVE_TAG || body.activation_state > FIXED_BASE_MULTI_BODY)
    return "activation state is unknown: " + std::to_string(body.activation_state);
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
  if (!areFinite({body.friction, body.rolling_friction, body.spinning_friction, body.restitution}))
    return "friction or restitution is not finite";
  // Some of these are infinite where a program says "never".
  for (const btScalar number :
       {body.linear_sleeping_threshold, body.angular_sleeping_threshold, body.ccd_radius,
        body.ccd_threshold, body.contact_processing_threshold, body.deactivation_time})
    if (std::isnan(number)) return "threshold of sleep or collision is not a number";
  return {};
}

std::string faultOfFlight(const AmbientState& ambient) {
  const FlightMemory& memory = ambient.memory;
  if (!memory.load_W.vector().allFinite() || !ambient.left_W.vector().allFinite() ||
      !std::isfinite(memory.substep))
    return "flight has numbers that are not finite";
  const WaveMemory& waves = ambient.waves;
  if (!waves.tilt_W[0].allFinite() || !waves.tilt_W[1].allFinite() ||
      !std::isfinite(waves.heave[0]) || !std::isfinite(waves.heave[1]) ||
      !std::isfinite(waves.energy()))
    return "waves have numbers that are not finite";
  if (const auto& met = ambient.met_B;
      met && !(met->normal.allFinite() && std::isfinite(met->height) &&
               std::isfinite(met->density) && std::isfinite(met->gravity)))
    return "surface of the water is not finite";
  const Medium& medium = ambient.medium;
  if (!(medium.density >= 0) || !(medium.viscosity >= 0) || !std::isfinite(medium.density) ||
      !std::isfinite(medium.viscosity) || !medium.velocity.allFinite() ||
      !medium.acceleration.allFinite())
    return "medium is not physical";
  return {};
}

std::string faultOf(const BodyState& body) {
  std::string fault = faultOfMotion(body);
  if (fault.empty()) fault = faultOfProperties(body);
  if (fault.empty() && body.ambient) fault = faultOfFlight(*body.ambient);
  return fault;
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
