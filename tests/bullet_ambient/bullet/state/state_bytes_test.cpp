#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <stdexcept>

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

// Checksums give no protection: writers of bytes can compute them.
TEST_F(StateBytes, WithARightChecksumButWrongContentAreRefused) {
  WorldState wrong = state;
  wrong.bodies[1].activation_state = 77;
  expectSays(encodeState(wrong), "activation state");
  wrong = state;
  wrong.bodies[2].inverse_mass = -1;
  expectSays(encodeState(wrong), "inverse mass");
  wrong = state;
  wrong.bodies[0].pose.getOrigin().setX(std::numeric_limits<btScalar>::quiet_NaN());
  expectSays(encodeState(wrong), "pose or velocity is not finite");
  wrong = state;
  wrong.bodies[1].angular_velocity.setZ(std::numeric_limits<btScalar>::infinity());
  expectSays(encodeState(wrong), "pose or velocity is not finite");
  wrong = state;
  const btVector3 zero(0, 0, 0);
  wrong.contacts[0].points.assign(5, btManifoldPoint(zero, zero, btVector3(0, 0, 1), 0));
  expectSays(encodeState(wrong), "a contact of 5 points; at most 4");
  wrong = state;
  wrong.contacts[0].pair.object_a = -3;
  expectSays(encodeState(wrong), "without an object");
  wrong = state;
  wrong.bodies[1].ambient->memory.substep = std::numeric_limits<double>::infinity();
  expectSays(encodeState(wrong), "not finite");
}

// Any of these numbers would spread through the world in the next step.
TEST_F(StateBytes, WithNumbersThatNoWorldCanHaveAreRefusedHoweverTheyCome) {
  constexpr auto kNaN = std::numeric_limits<btScalar>::quiet_NaN();
  constexpr auto kInfinity = std::numeric_limits<btScalar>::infinity();
  struct Forgery {
    std::function<void(WorldState&)> forge;
    const char* words;
  };
  const Forgery forgeries[] = {
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
      {[](WorldState& s) { s.bodies[1].ambient->waves.heave[1] = 1e200; }, "waves"},
      {[](WorldState& s) { s.bodies[1].ambient->waves.tilt_W[0].x() = 1e200; }, "waves"},
      {[](WorldState& s) {
         s.bodies[1].ambient->met_B = SurfacePlane{{0, 0, 2}, 0, 998, 9.81};
       },
       "normal"},
      {[](WorldState& s) {
         s.bodies[1].ambient->met_B = SurfacePlane{{0, 0, 1}, 0, -998, 9.81};
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

}  // namespace
}  // namespace ambient::test
