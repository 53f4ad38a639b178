#include "tests/golden/golden_world.h"

namespace ambient::test {
namespace {

// Bodies in contact with a floor, each other and a multibody, by settings of Bullet's solver.

constexpr int kContactSteps = 150;

using Settings = std::function<void(btContactSolverInfo&)>;

void addFloor(GoldenWorld& world) {
  GoldenBody floor;
  floor.mass = 0;
  floor.shape = &world.floor();
  world.addDry(floor).setFriction(bt(0.7));
}

GoldenBody falling(GoldenWorld& world, int index) {
  GoldenBody body;
  const double x = index;
  body.shape = index % 3 == 1 ? &world.ball() : &world.box();
  body.position = {0.05 * x, -0.04 * x, 0.35 + 0.45 * x};
  body.twist = {{1, 2 - x, 0.5}, {0.3, 0.2 * x, -2 - x}};
  body.mass = 30;
  body.moments = {0.5, 0.7, 0.9};
  return body;
}

// A tower of six bodies falls onto the floor: boxes and balls, in water, dry and locked.
void addTower(GoldenWorld& world) {
  world.add(falling(world, 0), bumpyInWater());
  addFloor(world);
  world.add(falling(world, 1), symmetricInWater()).setRollingFriction(bt(0.02));
  world.addDry(falling(world, 2)).setRestitution(bt(0.4));
  btRigidBody& locked = world.add(falling(world, 3), bumpyInWater());
  locked.setAngularFactor({1, 0, 1});
  locked.setLinearFactor({1, 1, 1});
  btRigidBody& bouncing = world.add(falling(world, 4), bumpyInWater());
  bouncing.setRestitution(bt(0.8));
  bouncing.setSpinningFriction(bt(0.05));
  world.add(falling(world, 5), symmetricInWater()).setFriction(bt(0.1));
}

GoldenRecord tower(const Settings& settings) {
  GoldenWorld world;
  settings(world.world().getSolverInfo());
  addTower(world);
  return world.run(kContactSteps);
}

// Two quick bodies above the floor with continuous collision; one turns by a radian per step.
GoldenRecord quick() {
  GoldenWorld world;
  for (int i = 0; i < 2; ++i) {
    btRigidBody& body = world.add(falling(world, i), bumpyInWater());
    body.setLinearVelocity({0, 0, -60});
    body.setCcdMotionThreshold(bt(0.05));
    body.setCcdSweptSphereRadius(bt(0.1));
  }
  world.body(1).setAngularVelocity({0, 200, 100});
  addFloor(world);
  return world.run(60);
}

// Two bodies fall asleep on the floor; a third one wakes them.
GoldenRecord sleep() {
  GoldenWorld world;
  for (int i = 0; i < 2; ++i) {
    GoldenBody resting = falling(world, 0);
    resting.position = {2.0 * i, 0, 0.25};
    resting.twist = {};
    resting.mass = 300;
    world.add(resting, i == 0 ? bumpyInWater() : symmetricInWater())
        .setSleepingThresholds(bt(0.8), bt(1));
  }
  addFloor(world);
  return world.run(1000, [&](int step) {
    if (step == 900) world.add(falling(world, 4), symmetricInWater());
  });
}

// Contacts whose normals are locked: a body that moves in the plane, and one on a rail.
void addLocked(GoldenWorld& world) {
  GoldenBody lying = falling(world, 0);
  lying.position = {1.5, 0, 0.15};
  btRigidBody& plane = world.add(lying, bumpyInWater());
  plane.setLinearFactor({1, 1, 0});
  plane.setAngularFactor({0, 0, 1});
  lying.position = {2.5, 0, 0.15};
  btRigidBody& rail = world.add(lying, symmetricInWater());
  rail.setLinearFactor({1, 0, 0});
  rail.setAngularFactor(0);
}

GoldenRecord lieLocked() {
  GoldenWorld world;
  addTower(world);
  addLocked(world);
  return world.run(60);
}

// A chain of rigid links swings into bodies in water.
GoldenRecord swingChain(const Settings& settings) {
  GoldenWorld world(GoldenWorld::Kind::kMultiBodies);
  settings(world.world().getSolverInfo());
  for (int i = 0; i < 3; ++i) {
    GoldenBody body = falling(world, i);
    body.position = {-0.4 - 0.5 * i, 0.03 * i, 0.5};
    body.twist.linear = {1, 0, 0};
    if (i == 2)
      world.addDry(body);
    else
      world.add(body, i == 0 ? bumpyInWater() : symmetricInWater());
  }
  addFloor(world);
  addLocked(world);
  world.addChain({0, 0, 1.2});
  return world.run(kContactSteps);
}

}  // namespace

std::vector<GoldenRun> goldenContacts() {
  const auto towerWith = [](const Settings& settings) { return [=] { return tower(settings); }; };
  const auto without = [](int mode) {
    return [mode](btContactSolverInfo& info) { info.m_solverMode &= ~mode; };
  };
  const auto with = [](int mode) {
    return [mode](btContactSolverInfo& info) { info.m_solverMode |= mode; };
  };
  const auto chainWith = [](const Settings& settings) {
    return [=] { return swingChain(settings); };
  };
  const Settings unchanged = [](btContactSolverInfo&) {};
  const Settings soft = [](btContactSolverInfo& info) {
    info.m_globalCfm = bt(1e-3);
    info.m_sor = bt(0.8);
  };
  return {
      {"tower", towerWith(unchanged)},
      {"tower_cold", towerWith(without(SOLVER_USE_WARMSTARTING))},
      {"tower_two_frictions", towerWith(with(SOLVER_USE_2_FRICTION_DIRECTIONS))},
      {"tower_shuffled", towerWith(with(SOLVER_RANDMIZE_ORDER))},
      {"tower_interleaved", towerWith(with(SOLVER_INTERLEAVE_CONTACT_AND_FRICTION_CONSTRAINTS))},
      {"tower_split",
       towerWith([](btContactSolverInfo& info) { info.m_splitImpulsePenetrationThreshold = 0; })},
      {"tower_soft", towerWith(soft)},
      {"locked", lieLocked},
      {"quick", quick},
      {"sleep", sleep},
      {"chain", chainWith(unchanged)},
      {"chain_soft", chainWith(soft)},
  };
}

namespace {

// Bodies in water on each kind of Bullet's joints: to the world, to each other, to a dry body.

using MakeJoint = std::function<btTypedConstraint*(btRigidBody& a, btRigidBody& b)>;

btTransform frame(double x) {
  return btTransform(btQuaternion(bt(0.2), bt(0.1), 0, 1).normalized(), {bt(x), 0, 0});
}

GoldenRecord swing(const MakeJoint& make) {
  GoldenWorld world;
  for (int i = 0; i < 4; ++i) {
    GoldenBody body;
    body.position = {0.6 * i, 0, 3};
    body.twist = {{0, 0.5 * i, 1}, {0, 0.1, 0.2}};
    body.mass = 20;
    body.moments = {0.4, 0.5, 0.6};
    if (i == 3)
      world.addDry(body);
    else
      world.add(body, i == 1 ? symmetricInWater() : bumpyInWater());
  }
  world.addJoint(make(world.body(0), btTypedConstraint::getFixedBody()));
  btJointFeedback feedback{};
  world.addJoint(make(world.body(1), world.body(0))).setJointFeedback(&feedback);
  world.addJoint(make(world.body(1), world.body(2)));
  world.addJoint(make(world.body(3), world.body(2)));
  return world.run(120, [&](int step) {
    if (step == 60) world.body(2).applyCentralForce(feedback.m_appliedForceBodyA);
  });
}

// Frame of a joint in b's axes that coincides with `in_a` in a's axes.
btTransform seenFrom(const btRigidBody& b, const btRigidBody& a, const btTransform& in_a) {
  return b.getWorldTransform().inverse() * a.getWorldTransform() * in_a;
}

btTypedConstraint* makeBall(btRigidBody& a, btRigidBody& b) {
  const btTransform at = frame(-0.3);
  return new btPoint2PointConstraint(a, b, at.getOrigin(), seenFrom(b, a, at).getOrigin());
}

btTypedConstraint* makeHinge(btRigidBody& a, btRigidBody& b) {
  auto* hinge = new btHingeConstraint(a, b, frame(-0.3), seenFrom(b, a, frame(-0.3)));
  hinge->enableAngularMotor(true, 2, bt(0.5));
  hinge->setLimit(bt(-0.2), bt(0.3));
  return hinge;
}

btTypedConstraint* makeSlider(btRigidBody& a, btRigidBody& b) {
  auto* slider = new btSliderConstraint(a, b, frame(0), seenFrom(b, a, frame(0)), true);
  slider->setLowerLinLimit(bt(-0.05));
  slider->setUpperLinLimit(bt(0.1));
  return slider;
}

btTypedConstraint* makeConeTwist(btRigidBody& a, btRigidBody& b) {
  auto* cone = new btConeTwistConstraint(a, b, frame(-0.3), seenFrom(b, a, frame(-0.3)));
  cone->setLimit(bt(0.3), bt(0.2), bt(0.1));
  return cone;
}

btTypedConstraint* makeFixed(btRigidBody& a, btRigidBody& b) {
  return new btFixedConstraint(a, b, frame(0), seenFrom(b, a, frame(0)));
}

btTypedConstraint* makeSpring(btRigidBody& a, btRigidBody& b) {
  auto* spring = new btGeneric6DofSpring2Constraint(a, b, frame(0), seenFrom(b, a, frame(0)));
  for (int axis = 0; axis < 6; ++axis) {
    spring->setLimit(axis, bt(-0.2), bt(0.2));
    spring->enableSpring(axis, true);
    spring->setStiffness(axis, bt(400));
    spring->setDamping(axis, bt(3));
  }
  return spring;
}

}  // namespace

std::vector<GoldenRun> goldenJoints() {
  std::vector<GoldenRun> runs;
  const std::vector<std::pair<std::string, MakeJoint>> joints = {
      {"ball", makeBall},     {"hinge", makeHinge},
      {"slider", makeSlider}, {"cone_twist", makeConeTwist},
      {"fixed", makeFixed},   {"spring", makeSpring}};
  for (const auto& [name, make] : joints)
    runs.push_back({"joint_" + name, [make = make] { return swing(make); }});
  return runs;
}

}  // namespace ambient::test
