#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "bullet_ambient/fluid.h"
#include "bullet_ambient/saved_state.h"
#include "tests/bullet_ambient/bullet/fluid_world.h"

namespace ambient::test {

/// A world that is saved and restored: its fluid, and one step of it.
struct SavedRun {
  Fluid& fluid;
  std::function<void()> step;
};

/// Bytes of all that moves, without Bullet's pairs and contacts.
inline std::string motionBytes(const Fluid& fluid) {
  WorldState state = fluid.save();
  state.pairs.clear();
  state.contacts.clear();
  state.boxes.clear();
  state.next_pair = state.new_pairs = 0;
  return encodeState(state);
}

/// Bytes of the motion after each step.
inline std::vector<std::string> record(const SavedRun& run, int steps) {
  std::vector<std::string> motions;
  for (int i = 0; i < steps; ++i) {
    run.step();
    motions.push_back(motionBytes(run.fluid));
  }
  return motions;
}

inline void expectSameMotion(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_TRUE(a[i] == b[i]) << "bits differ after step " << i + 1;
}

/// Knows the fluid bodies of a state's rigid bodies.
inline FluidBodyLookup lookupOf(const WorldState& state) {
  std::map<std::string, std::shared_ptr<const FluidBody>> known;
  for (const BodyState& body : state.bodies)
    if (body.ambient) known[body.ambient->def.fluid_body->name] = body.ambient->def.fluid_body;
  return [known](const std::string& name) { return known.at(name); };
}

/// Expects that `other`, restored from the bytes of a state of `run`, goes on as that bit for bit.
/// `other` is `run` itself, or a world that was built by the same code. `lookup`: knows the fluid
/// bodies; default: those of rigid bodies.
inline void expectGoesOn(const SavedRun& run, const SavedRun& other, int steps,
                         const FluidBodyLookup& lookup = {}) {
  const WorldState state = run.fluid.save();
  const std::string bytes = encodeState(state), motion = motionBytes(run.fluid);
  const double time = run.fluid.time();
  const auto motions = record(run, steps);
  other.fluid.restore(decodeState(bytes, "bytes", lookup ? lookup : lookupOf(state)));
  EXPECT_TRUE(motionBytes(other.fluid) == motion);
  EXPECT_EQ(other.fluid.time(), time);
  expectSameMotion(motions, record(other, steps));
}

constexpr double kSceneStep = 1.0 / 60;

/// Rounds to float: .bullet files store numbers in float, for example sizes and margins of shapes.
inline btScalar exactly(double value) { return static_cast<btScalar>(static_cast<float>(value)); }

/// Scene: a floor, a pile of boxes and balls in water, a hinged chain that swings into the pile.
/// Beside it a plate that flutters down, and an ordinary ball. Each instance is built in the same
/// way.
class StateScene {
 public:
  StateScene() {
    scene.world.getDispatchInfo().m_deterministicOverlappingPairs = true;
    scene.world.setGravity(btVector3(0, 0, btScalar(-9.81)));
    for (btConvexInternalShape* shape :
         std::initializer_list<btConvexInternalShape*>{&floor_shape, &box_shape, &plate_shape}) {
      shape->setMargin(exactly(0.03125));
    }
    BodyDef floor;
    floor.mass = 0;
    floor.moments.setZero();
    floor.start.position = {0, 0, -1};
    floor.shape = &floor_shape;
    scene.add(floor);
    addPile();
    addChain();
    addPlate();
    scene.add({0.7, Vector3::Constant(0.02), startAt({0.1, 0.15, 2.5}), &ball_shape});
  }

  void step(int count) { scene.step(kSceneStep, count); }
  btRigidBody& body(int i) {
    return *btRigidBody::upcast(scene.world.getCollisionObjectArray()[i]);
  }
  std::string motion() const { return motionBytes(scene.fluid); }
  SavedRun saved() {
    return {scene.fluid, [this] { step(1); }};
  }
  std::shared_ptr<const FluidBody> find(const std::string& name) const {
    for (const auto& shape : {box_fluid, ball_fluid, plate_fluid}) {
      if (shape->name == name) return shape;
    }
    return nullptr;
  }
  FluidBodyLookup lookup() const {
    return [this](const std::string& name) { return find(name); };
  }

  btBoxShape floor_shape{btVector3(8, 8, 1)};
  btBoxShape box_shape{btVector3(exactly(0.25), exactly(0.1875), exactly(0.125))};
  btSphereShape ball_shape{exactly(0.1875)};
  btBoxShape plate_shape{btVector3(exactly(0.25), exactly(0.25), exactly(0.03125))};
  std::shared_ptr<FluidBody> box_fluid = named("box", Vector3(0.3, 0.22, 0.15));
  std::shared_ptr<FluidBody> ball_fluid = named("ball", Vector3::Constant(0.1875));
  std::shared_ptr<FluidBody> plate_fluid = named("plate", Vector3(0.28, 0.28, 0.04));
  FluidWorld scene;

 private:
  static std::shared_ptr<FluidBody> named(const std::string& name, const Vector3& semi_axes) {
    auto shape = std::make_shared<FluidBody>(meshedEllipsoid(semi_axes, 1));
    shape->name = name;
    return shape;
  }
  btRigidBody& add(BodyDef def, const std::shared_ptr<FluidBody>& shape, const Medium& medium) {
    const double relative_density = def.mass;
    def.mass = relative_density * medium.density * shape->volume;
    def.moments = def.mass * Vector3(0.021, 0.03, 0.035);
    btRigidBody& body = scene.add(def);
    body.forceActivationState(ACTIVE_TAG);
    body.setRestitution(btScalar(0.2));
    AttachDef attach{shape, medium};
    attach.flow.law = PressureLaw::kPublished;
    attach.flow.separation_angle = 1.8;
    attach.fluid_frame.translation = Vector3(0.01, 0.02, -0.015);
    scene.fluid.add(body, attach);
    return body;
  }
  void addPile() {
    for (int i = 0; i < 8; ++i) {
      add({3, Vector3::Ones(),
           startAt({0.08 * i, -0.05 * i, 0.2 + 0.4 * i}, {{0.3 * i, 0, 1}, Vector3::Zero()}),
           i % 2 ? static_cast<btCollisionShape*>(&ball_shape) : &box_shape},
          i % 2 ? ball_fluid : box_fluid, water());
    }
  }
  void addChain() {
    btRigidBody* last = nullptr;
    for (int i = 0; i < 3; ++i) {
      btRigidBody& link = add({2, Vector3::Ones(), startAt({2.5 - 0.5 * i, 0, 2}), &ball_shape},
                              ball_fluid, water());
      const btVector3 axis(0, 1, 0), right(btScalar(0.25), 0, 0);
      // A joint with one body would lose its place in a .bullet file.
      btRigidBody& other = last ? *last : body(0);
      const btVector3 place = last ? btVector3(-right) : btVector3(btScalar(2.75), 0, 3);
      scene.contents.take(
          std::make_unique<btHingeConstraint>(link, other, right, place, axis, axis));
      last = &link;
    }
  }
  void addPlate() {
    add({1.5, Vector3::Ones(), startAt({-3, 0, 40}, {{0.2, 1, 0.1}, Vector3::Zero()}),
         &plate_shape},
        plate_fluid, water());
  }
};

}  // namespace ambient::test
