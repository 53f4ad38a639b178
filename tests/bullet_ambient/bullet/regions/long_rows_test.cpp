#include <BulletDynamics/Featherstone/btMultiBodyPoint2Point.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "bullet_ambient/reading.h"
#include "tests/bullet_ambient/bullet/regions/region_world.h"

// Long bodies with joints and contacts, and what is read of them; docs/theory.md section 16.
namespace ambient::test {
namespace {

const Vector3 kStick(1, 0.04, 0.05);  // [m]

/// Contact or joint of a stick; none could turn it about the vertical.
enum class StickRows { kNone, kHinge, kGround };

/// A stick of 1.5 times the density of its water, which turns, above a plate without friction.
struct StickScene : RobotWorld {
  StickScene(Mover mover, StickRows rows) {
    fluid.addRegion(turningWater(kTurning));
    const double mass = 1500 * kStick.prod();
    const btVector3 moments = toBullet(boxMoments(kStick, mass));
    AttachDef def{longBox(kStick, 8)};
    if (mover == Mover::kRigid) {
      body = &contents.add(mass, moments, box_, btTransform::getIdentity());
      body->setActivationState(DISABLE_DEACTIVATION);
      body->setFriction(0);
      fluid.add(*body, def);
    } else {
      auto robot = std::make_unique<btMultiBody>(0, bt(mass), moments, false, false);
      robot->finalizeMultiDof();
      tree = &takeUndamped(std::move(robot));
      contents.addCollider(*tree, -1, box_).setFriction(0);
      fluid.add(*tree, -1, def);
    }
    if (rows == StickRows::kHinge) addHinge();
    if (rows != StickRows::kGround) return;
    world.setGravity({0, 0, bt(-9.81)});
    const double height = (kStick.z() + 2) / 2;
    contents.add(0, {0, 0, 0}, ground_,
                 btTransform(btQuaternion::getIdentity(), {0, 0, bt(-height)}));
  }
  double spin() const {
    return static_cast<double>(body ? body->getAngularVelocity().z() : tree->getBaseOmega().z());
  }

  btRigidBody* body = nullptr;
  btMultiBody* tree = nullptr;

 private:
  // A multibody is held at two points of the axis.
  void addHinge() {
    if (body) {
      contents.join(
          std::make_unique<btHingeConstraint>(*body, btVector3(0, 0, 0), btVector3(0, 0, 1)));
      return;
    }
    for (const double z : {-0.2, 0.2}) {
      const btVector3 point(0, 0, bt(z));
      take(std::make_unique<btMultiBodyPoint2Point>(tree, -1, nullptr, point, point));
    }
  }

  btBoxShape box_{toBullet(kStick / 2)}, ground_{btVector3(2, 2, 1)};
};

TEST(LongRows, AStickTurnsWithItsWaterAsWithoutThem) {
  for (const Mover mover : kMovers) {
    std::vector<double> free;
    for (const StickRows rows : {StickRows::kNone, StickRows::kHinge, StickRows::kGround}) {
      StickScene scene(mover, rows);
      std::vector<double> spins;
      for (int second = 0; second < 10; ++second) {
        scene.step(1.0 / 60, 60);
        spins.push_back(scene.spin());
      }
      if (rows == StickRows::kNone) free = spins;
      EXPECT_GT(spins.back(), 0.8 * kTurning);
      for (std::size_t i = 0; i < free.size(); ++i)
        EXPECT_NEAR(spins[i] / free[i], 1, 0.005)
            << static_cast<int>(mover) << " " << static_cast<int>(rows) << " " << i;
    }
  }
}

const Vector3 kBar(20, 0.5, 0.6);  // [m]

/// A bar at rest at the origin of which less than a half is in a current across it.
struct BarScene : RobotWorld {
  explicit BarScene(const FluidRegion& current) {
    fluid.addRegion(filledWith(longWater()));
    fluid.addRegion(current);
    const double mass = 1000 * kBar.prod();
    body = &contents.add(mass, toBullet(boxMoments(kBar, mass)), no_shape_,
                         btTransform::getIdentity());
    body->setActivationState(DISABLE_DEACTIVATION);
    fluid.add(*body, {longBox(kBar, 8)});
    read = fluid.find(*body);
    read->readWrench(true);
  }

  btRigidBody* body = nullptr;
  std::optional<Immersed> read;

 private:
  btEmptyShape no_shape_;
};

const FluidRegion& currentAcross() {
  static const FluidRegion current = halfSpace(0, 5, longWater({0, 1, 0}));
  return current;
}

// The station ahead has 5/18 of the load of a bar that is all in the current, at its place.
TEST(LongRows, TheWrenchIsTheSumOverStations) {
  const BarScene all(filledWith(longWater({0, 1, 0}))), some(currentAcross());
  const Wrench whole = all.read->wrench().total(), part = some.read->wrench().total();
  EXPECT_GT(whole.force.y(), 0);
  const double share = 5.0 / 18, place = std::sqrt(0.6) / 2 * kBar.x();
  EXPECT_NEAR(part.force.y() / whole.force.y(), share, 1e-6);
  EXPECT_NEAR(part.torque.z() / (whole.force.y() * place), share, 1e-6);
  EXPECT_EQ(some.read->wet().share, 1);
  EXPECT_NEAR(some.read->wet().volume, kBar.prod(), 1e-9 * kBar.prod());
}

// The momentum grows by what is read, and what the joint adds is what Bullet reports of it.
TEST(LongRows, TheBalanceOfTheMomentumHolds) {
  for (const bool has_joint : {false, true}) {
    BarScene scene(currentAcross());
    btJointFeedback feedback;
    if (has_joint) {
      auto hinge =
          std::make_unique<btHingeConstraint>(*scene.body, btVector3(-4, 0, 0), btVector3(0, 0, 1));
      hinge->setJointFeedback(&feedback);
      hinge->enableFeedback(true);
      scene.contents.join(std::move(hinge));
    }
    const double mass = 1000 * kBar.prod();
    const Vector3 moments = boxMoments(kBar, mass);
    const auto momentum = [&] {
      return Wrench{moments.z() * toVector3(scene.body->getAngularVelocity()),
                    mass * toVector3(scene.body->getLinearVelocity())};
    };
    for (int i = 0; i < 120; ++i) {
      const Wrench before = momentum();
      scene.step(1.0 / 60);
      Wrench change = momentum();
      change -= before;
      const FluidWrench read = scene.read->wrench();
      const Wrench all = read.total() + read.constraints;
      const double size = read.pressure.force.norm() + read.constraints.force.norm();
      EXPECT_LT((60 * change.force - all.force).norm(), byPrecision(1e-9, 1e-3) * size) << i;
      EXPECT_NEAR(60 * change.torque.z(), all.torque.z(),
                  byPrecision(1e-9, 1e-3) * size * kBar.x());
      if (!has_joint) continue;
      EXPECT_LT((read.constraints.force - toVector3(feedback.m_appliedForceBodyA)).norm(),
                byPrecision(1e-9, 1e-3) * size)
          << i;
    }
    EXPECT_GT(std::abs(scene.body->getAngularVelocity().z()), 0.001);
  }
}

// Momentum that the added mass takes is what the fluid that moves along gains, but for errors of a
// step.
TEST(LongRows, TheAddedMassTakesItsMomentum) {
  BarScene scene(currentAcross());
  scene.step(1.0 / 60, 30);
  const double speed = static_cast<double>(scene.body->getLinearVelocity().y());
  scene.step(1.0 / 60);
  const double rate = 60 * (static_cast<double>(scene.body->getLinearVelocity().y()) - speed);
  const double added = 1000 * scene.read->fluidBody()->added_mass(4, 4);
  EXPECT_GT(rate, 0);
  EXPECT_NEAR(scene.read->wrench().added_mass.force.y() / (-added * rate), 1, 0.02);
}

}  // namespace
}  // namespace ambient::test
