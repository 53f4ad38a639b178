#include <gtest/gtest.h>

#include <initializer_list>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/saved_state.h"

namespace ambient::test {
namespace {

// Another number for each stored field, so that an order that changed shows in the bytes.
class Numbers {
 public:
  template <class... Field>
  void operator()(Field&... fields) {
    (put(fields), ...);
  }

 private:
  template <class Number>
  void put(Number& number) {
    number = static_cast<Number>(++last_);
  }
  void put(bool& flag) { flag = ++last_ % 3 == 0; }
  void put(btVector3& v) { operator()(v[0], v[1], v[2]); }
  void put(btQuaternion& q) { operator()(q[0], q[1], q[2], q[3]); }
  void put(btTransform& pose) {
    for (int row = 0; row < 3; ++row) put(pose.getBasis()[row]);
    put(pose.getOrigin());
  }
  void put(Vector3& v) { operator()(v.x(), v.y(), v.z()); }
  void put(VectorsOf<double>& v) { operator()(v.x, v.y, v.z); }
  void put(Matrix3& m) {
    for (int i = 0; i < 9; ++i) put(m.data()[i]);
  }
  template <std::size_t kSize>
  void put(std::array<btScalar, kSize>& numbers) {
    for (btScalar& number : numbers) put(number);
  }
  void put(std::vector<btScalar>& numbers) {
    numbers.resize(3);
    for (btScalar& number : numbers) put(number);
  }

  int last_ = 0;
};

void fill(Numbers& n, ObjectState& s) {
  n(s.pose, s.interpolation_pose, s.interpolation_linear_velocity, s.interpolation_angular_velocity,
    s.friction, s.rolling_friction, s.spinning_friction, s.restitution, s.ccd_radius,
    s.ccd_threshold, s.contact_processing_threshold, s.deactivation_time, s.activation_state,
    s.collision_flags);
}

void fill(Numbers& n, AmbientState& s) {
  AttachDef& def = s.def;
  def.fluid_body = std::make_shared<FluidBody>();
  def.flow.law = PressureLaw::kForm;
  def.flow.precision = LoadPrecision::kDouble;
  n(def.medium.density, def.medium.viscosity, def.medium.velocity, def.medium.acceleration,
    def.follow_regions, def.wave_damping, def.flow.separation_angle, def.flow.skin_friction,
    def.flow.stall_lag, def.flow.maximum_load_error, def.flight.tolerance, def.flight.max_substeps,
    def.fluid_frame.rotation, def.fluid_frame.translation);
  n(s.medium.density, s.medium.viscosity, s.medium.velocity, s.medium.acceleration, s.place.region,
    s.place.is_above, s.place.is_at_surface, s.flow.until, s.flow.position, s.flow.velocity,
    s.flow.change, s.flow.parts, s.flow.region, s.flow.is_above);
  SurfacePlane& met = s.met_B.emplace();
  n(met.normal, met.height, met.density, met.gravity);
  n(s.waves.heave.first, s.waves.tilt_W[0], s.waves.heave.second, s.waves.tilt_W[1],
    s.waves.heave_energy, s.waves.tilt_energy, s.memory.load_W.torque, s.memory.load_W.force,
    s.memory.has_load, s.memory.substep, s.wake.velocity_W.angular, s.wake.velocity_W.linear,
    s.wake.has_begun, s.left_W.angular, s.left_W.linear);
  AmbientCounters& c = s.counters;
  n(c.substeps, c.load_evaluations, c.faces, c.guarded, c.coarse, c.halted, c.energy_removed,
    c.rows, c.joint_rows, c.rejected, c.regions_asked, c.medium_changes, c.too_long);
}

void fill(Numbers& n, BodyState& s) {
  fill(n, static_cast<ObjectState&>(s));
  n(s.linear_velocity, s.angular_velocity, s.total_force, s.total_torque, s.gravity,
    s.inverse_inertia, s.linear_factor, s.angular_factor, s.inverse_mass, s.linear_damping,
    s.angular_damping, s.linear_sleeping_threshold, s.angular_sleeping_threshold, s.flags);
}

void fill(Numbers& n, MultiBodyState& s) {
  n(s.position, s.interpolation_position, s.orientation, s.interpolation_orientation, s.velocity);
  s.links.resize(2);
  for (MultiBodyLinkState& link : s.links)
    n(link.mass, link.inertia, link.force, link.torque, link.joint_position, link.joint_force,
      link.pose);
  fill(n, s.links[1].collider.emplace());
  n(s.linear_damping, s.angular_damping, s.velocity_limit, s.sleep_timer, s.sleep_threshold,
    s.sleep_timeout, s.is_awake, s.can_sleep, s.can_wake_up, s.has_gyroscopic_term, s.turn_reserve);
  s.fluids.resize(2);
  n(s.fluids[0].link, s.fluids[1].link);
  for (LinkFluidState& fluid : s.fluids) fill(n, fluid.ambient);
}

void fill(Numbers& n, btManifoldPoint& p) {
  n(p.m_localPointA, p.m_localPointB, p.m_positionWorldOnB, p.m_positionWorldOnA,
    p.m_normalWorldOnB, p.m_lateralFrictionDir1, p.m_lateralFrictionDir2, p.m_distance1,
    p.m_combinedFriction, p.m_combinedRollingFriction, p.m_combinedSpinningFriction,
    p.m_combinedRestitution, p.m_appliedImpulse, p.m_prevRHS, p.m_appliedImpulseLateral1,
    p.m_appliedImpulseLateral2, p.m_contactMotion1, p.m_contactMotion2, p.m_contactCFM,
    p.m_contactERP, p.m_frictionCFM, p.m_partId0, p.m_partId1, p.m_index0, p.m_index1,
    p.m_contactPointFlags, p.m_lifeTime);
}

WorldState filledState() {
  Numbers n;
  WorldState s;
  s.bodies.resize(2);
  for (BodyState& body : s.bodies) fill(n, body);
  fill(n, s.bodies[1].ambient.emplace());
  s.multi_bodies.resize(1);
  fill(n, s.multi_bodies[0]);
  s.pairs.resize(2);
  for (PairState& pair : s.pairs) n(pair.object_a, pair.object_b);
  s.contacts.resize(1);
  n(s.contacts[0].pair.object_a, s.contacts[0].pair.object_b, s.contacts[0].part);
  fill(n, s.contacts[0].points.emplace_back());
  s.joints.resize(1);
  n(s.joints[0].is_enabled, s.joints[0].applied_impulse);
  s.multi_body_joints.resize(1);
  n(s.multi_body_joints[0].applied_impulses, s.time, s.random_seed);
  return s;
}

// Recorded with the first program of version 15. Who changes the bytes raises the version.
TEST(StateFormat, HasTheBytesOfVersion15) {
  const std::string bytes = encodeState(filledState());
  const bool in_double = sizeof(btScalar) == 8;
  EXPECT_EQ(bytes.size(), in_double ? 4995u : 3779u);
  EXPECT_EQ(fnv1a64(bytes), in_double ? 243768639118758201u : 14776587064353551724u);
}

}  // namespace
}  // namespace ambient::test
