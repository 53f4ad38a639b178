#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <stdexcept>

#include "bullet_ambient/base/fnv1a.h"
#include "bullet_ambient/fluid_body/fluid_body.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/state/state_scene.h"
#include "tests/support/refusal_of.h"

namespace ambient::test {
namespace {

// Returns the sentence of decodeState()'s refusal; empty if accepted.
std::string refusal(const std::string& bytes, const FluidBodyLookup& lookup) {
  const std::string sentence = refusalOf([&] { decodeState(bytes, "quick.save", lookup); });
  if (sentence.empty()) return sentence;
  EXPECT_EQ(sentence.find("quick.save: the saved state "), 0u) << sentence;
  EXPECT_EQ(sentence.find('\n'), std::string::npos);
  return sentence;
}

btManifoldPoint& firstPoint(WorldState& state) {
  for (ContactState& contact : state.contacts)
    if (!contact.points.empty()) return contact.points.front();
  throw std::logic_error("nothing touches");
}

class StateBytes : public testing::Test {
 protected:
  StateBytes() {
    scene.step(80);
    state = scene.scene.fluid.save();
    bytes = encodeState(state);
  }
  void expectSays(const std::string& refused, const char* words) {
    EXPECT_NE(refusal(refused, scene.lookup()).find(words), std::string::npos)
        << refusal(refused, scene.lookup());
  }

  StateScene scene;
  WorldState state;
  std::string bytes;
};

TEST_F(StateBytes, CarryTheStateBitForBit) {
  const WorldState decoded = decodeState(bytes, "quick.save", scene.lookup());
  EXPECT_EQ(encodeState(decoded) == bytes, true);
  StateScene other;
  other.scene.fluid.restore(decoded);
  scene.step(60);
  other.step(60);
  EXPECT_EQ(scene.motion() == other.motion(), true);
}

TEST_F(StateBytes, CarryTheLaw) {
  const auto in_fluid = std::find_if(state.bodies.begin(), state.bodies.end(),
                                     [](const BodyState& body) { return body.ambient; });
  in_fluid->ambient->def.flow.law = PressureLaw::kForm;
  in_fluid->ambient->def.flow.stall_lag = 1.25;
  const WorldState decoded = decodeState(encodeState(state), "quick.save", scene.lookup());
  const auto& flow =
      decoded.bodies[static_cast<std::size_t>(in_fluid - state.bodies.begin())].ambient->def.flow;
  EXPECT_EQ(flow.law, PressureLaw::kForm);
  EXPECT_EQ(flow.stall_lag, 1.25);
}

TEST_F(StateBytes, NameEveryFluidBodyOnce) {
  const auto in_fluid = std::find_if(state.bodies.begin(), state.bodies.end(),
                                     [](const BodyState& body) { return body.ambient; });
  const BodyState twin = *in_fluid;
  FluidBody other = *twin.ambient->def.fluid_body;
  other.volume *= 2;
  state.bodies.push_back(twin);
  state.bodies.back().ambient->def.fluid_body = std::make_shared<FluidBody>(other);
  const std::string said = refusalOf([&] { encodeState(state); });
  EXPECT_NE(said.find("have the name '" + other.name + "'"), std::string::npos) << said;
}

TEST_F(StateBytes, AreRefusedWhenTheyAreCutShort) {
  for (std::size_t size = 0; size < bytes.size(); size += size < 200 ? 1 : 97) {
    ASSERT_NE(refusal(bytes.substr(0, size), scene.lookup()), "") << size;
  }
  expectSays(bytes + "x", "damaged");
}

TEST_F(StateBytes, AreRefusedWhenAnyOfThemIsDamaged) {
  for (std::size_t place = 0; place < bytes.size(); place += place < 200 ? 1 : 97) {
    std::string damaged = bytes;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x40);
    ASSERT_NE(refusal(damaged, scene.lookup()), "") << place;
  }
}

TEST_F(StateBytes, NameWhatIsForeign) {
  expectSays("BULLETf-v324 and more than enough bytes", "does not begin with AMBSTATE");
  std::string other = bytes;
  other[8] = 99;
  expectSays(other, "version 99");
  other = bytes;
  other[12] = sizeof(btScalar) == 8 ? 4 : 8;
  expectSays(other, sizeof(btScalar) == 8 ? "have 4 bytes, here they have 8"
                                          : "have 8 bytes, here they have 4");
}

TEST_F(StateBytes, NamesOfSeveralLinesAreToldInOne) {
  for (BodyState& body : state.bodies) {
    if (!body.ambient) continue;
    auto renamed = std::make_shared<FluidBody>(*body.ambient->def.fluid_body);
    renamed->name += "\n\x1b[2J";
    body.ambient->def.fluid_body = renamed;
  }
  EXPECT_NE(refusal(encodeState(state), {}).find("\\n?[2J', which is not known"),
            std::string::npos);
}

TEST_F(StateBytes, NameTheFluidBodyThatIsMissingOrAnother) {
  EXPECT_NE(refusal(bytes, {}).find("'box', which is not known"), std::string::npos);
  const auto changed = [this](const std::string& name) {
    auto body = std::make_shared<FluidBody>(*scene.find(name));
    body->faces.area[0] *= 1 + 1e-15;
    return body;
  };
  EXPECT_NE(refusal(bytes, changed).find("another content of the fluid body 'box'"),
            std::string::npos);
}

// Any of these numbers would spread through the world in the next step. Checksums give no
// protection: writers of bytes can compute them.
TEST_F(StateBytes, WithNumbersThatNoWorldCanHaveAreRefusedHoweverTheyCome) {
  constexpr auto kNaN = std::numeric_limits<btScalar>::quiet_NaN();
  constexpr auto kInfinity = std::numeric_limits<btScalar>::infinity();
  struct Forgery {
    std::function<void(WorldState&)> forge;
    const char* words;
  };
  const Forgery forgeries[] = {
      {[](WorldState& s) { s.bodies[1].activation_state = 77; }, "activation state"},
      {[](WorldState& s) { s.bodies[2].inverse_mass = -1; }, "inverse mass"},
      {[](WorldState& s) { s.bodies[0].pose.getOrigin().setX(kNaN); }, "pose or velocity is not"},
      {[](WorldState& s) { s.bodies[1].angular_velocity.setZ(kInfinity); }, "pose or velocity"},
      {[](WorldState& s) { s.contacts[0].points.assign(5, firstPoint(s)); },
       "a contact of 5 points; at most 4"},
      {[](WorldState& s) { s.contacts[0].pair.object_a = -3; }, "without an object"},
      {[](WorldState& s) { s.bodies[1].ambient->memory.substep = 1 / 0.0; }, "not finite"},
      {[](WorldState& s) { s.bodies[1].total_force.setX(kNaN); }, "number 1, whose force, torque"},
      {[](WorldState& s) { s.bodies[1].total_torque.setY(kInfinity); }, "force, torque"},
      {[](WorldState& s) { s.bodies[1].gravity.setZ(-kInfinity); }, "force, torque or gravity"},
      {[](WorldState& s) { s.bodies[1].inverse_inertia.setX(-1); }, "inverse inertia"},
      {[](WorldState& s) { s.bodies[1].inverse_inertia.setY(kNaN); }, "inverse inertia"},
      {[](WorldState& s) { s.bodies[1].linear_factor.setZ(kNaN); }, "factor"},
      {[](WorldState& s) { s.bodies[1].linear_damping = kNaN; }, "damping"},
      {[](WorldState& s) { s.bodies[1].angular_damping = -1; }, "damping"},
      {[](WorldState& s) { s.bodies[1].friction = kInfinity; }, "friction"},
      {[](WorldState& s) { s.bodies[1].ccd_threshold = kNaN; }, "threshold"},
      {[](WorldState& s) { s.bodies[1].ambient->medium.density = -1; }, "medium"},
      {[](WorldState& s) { s.bodies[1].ambient->memory.substep = -0.01; }, "substep"},
      {[](WorldState& s) { s.bodies[1].ambient->memory.load_W.force.z() = 1e200; }, "load"},
      {[](WorldState& s) { s.bodies[1].ambient->memory.load_W.torque.x() = -1e200; }, "load"},
      {[](WorldState& s) { s.bodies[1].ambient->left_W.angular.y() = 1e200; }, "velocity"},
      {[](WorldState& s) { s.bodies[1].ambient->waves.heave_energy = -1; }, "waves"},
      {[](WorldState& s) { s.bodies[1].ambient->waves.tilt_energy = -1e-9; }, "waves"},
      {[](WorldState& s) { s.bodies[1].ambient->waves.heave.second = 1e200; }, "waves"},
      {[](WorldState& s) { s.bodies[1].ambient->waves.tilt_W[0].x = 1e200; }, "waves"},
      {[](WorldState& s) {
         s.bodies[1].ambient->plane_B = SurfacePlane{{0, 0, 2}, 0, 998, 9.81};
       },
       "normal"},
      {[](WorldState& s) {
         s.bodies[1].ambient->plane_B = SurfacePlane{{0, 0, 1}, 0, -998, 9.81};
       },
       "surface of the water"},
      {[](WorldState& s) { firstPoint(s).m_localPointA.setX(kNaN); }, "contact point"},
      {[](WorldState& s) { firstPoint(s).m_appliedImpulse = kNaN; }, "contact point"},
      {[](WorldState& s) { firstPoint(s).m_normalWorldOnB *= 2; }, "contact point"}};
  for (const Forgery& forgery : forgeries) {
    WorldState wrong = state;
    forgery.forge(wrong);
    expectSays(encodeState(wrong), forgery.words);
    const std::string said =
        refusalOf<std::invalid_argument>([&] { scene.scene.fluid.restore(wrong); });
    EXPECT_NE(said.find(forgery.words), std::string::npos) << forgery.words << ": " << said;
  }
  WorldState now = scene.scene.fluid.save();
  EXPECT_EQ(encodeState(now), bytes);
}

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
    def.follow_regions, def.wave_damping, def.added_mass_factor, def.load_factor,
    def.flow.separation_angle, def.flow.skin_friction, def.flow.stall_lag,
    def.flow.maximum_load_error, def.flight.tolerance, def.flight.max_substeps,
    def.fluid_frame.rotation, def.fluid_frame.translation, def.holds.are_open, def.holds.atmosphere,
    def.holds.sloshing_damping);
  n(s.medium.density, s.medium.viscosity, s.medium.velocity, s.medium.acceleration,
    s.location.region, s.location.is_above, s.location.is_at_surface, s.flow.until, s.flow.position,
    s.flow.velocity, s.flow.change, s.flow.parts, s.flow.region, s.flow.is_above);
  SurfacePlane& met = s.plane_B.emplace();
  n(met.normal, met.height, met.density, met.gravity);
  n(s.waves.heave.first, s.waves.tilt_W[0], s.waves.heave.second, s.waves.tilt_W[1],
    s.waves.heave_energy, s.waves.tilt_energy, s.memory.load_W.torque, s.memory.load_W.force,
    s.memory.has_load, s.memory.substep, s.wake.velocity_W.angular, s.wake.velocity_W.linear,
    s.wake.has_begun, s.has_met_water, s.has_sunk, s.left_W.angular, s.left_W.linear);
  s.holds.resize(2);
  s.is_shut.assign(3, 1);
  for (AddedHole& hole : s.holes = std::vector<AddedHole>(1))
    n(hole.hold, hole.area, hole.place, hole.normal);
  for (HoldState& hold : s.holds)
    n(hold.volume, hold.pump, hold.flooded, hold.drained, hold.is_sealed, hold.air);
  for (Sloshing& sloshing : s.sloshing = std::vector<Sloshing>(2))
    n(sloshing.is_known, sloshing.displacement_W, sloshing.velocity_W);
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
      link.turn_in_parent, link.way_from_parent, link.pose);
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
  BoxState& box = s.boxes.emplace_back();
  n(box.smallest, box.largest, box.leaf_smallest, box.leaf_largest, s.next_pair, s.new_pairs,
    s.looks_at_pairs);
  return s;
}

// Recorded with the first program of version 19. Who changes the bytes raises the version.
TEST(StateFormat, HasTheBytesOfVersion19) {
  const std::string bytes = encodeState(filledState());
  const bool in_double = sizeof(btScalar) == 8;
  EXPECT_EQ(bytes.size(), in_double ? 6098u : 4778u);
  EXPECT_EQ(fnv1a64(bytes), in_double ? 11938515436812939732u : 7673603275399839286u);
}

}  // namespace
}  // namespace ambient::test
