#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"

namespace ambient::test {
namespace {

constexpr double kPoseStep = 1.0 / 60;
const double kPoseRounding = byPrecision(1e-14, 1e-5);  // of numbers of size 1

RobotDef robotOfAllJoints(double speed) {
  RobotDef def;
  def.links = 10;
  def.joints = Joints::kAll;
  def.speed = speed;
  return def;
}

// Numbers of the pose, and what Bullet keeps of its joints.
Eigen::VectorXd numbersOf(const btMultiBody& body) {
  Eigen::VectorXd all(7 + 11 * body.getNumLinks());
  const auto put = [&all](Eigen::Index at, const btScalar* numbers, int count) {
    for (int i = 0; i < count; ++i) all[at + i] = static_cast<double>(numbers[i]);
  };
  put(0, body.getBasePos(), 3);
  put(3, body.getWorldToBaseRot(), 4);
  for (int i = 0; i < body.getNumLinks(); ++i) {
    const btMultibodyLink& link = body.getLink(i);
    all.segment<4>(7 + 11 * i).setZero();
    put(7 + 11 * i, link.m_jointPos, link.m_posVarCount);
    put(11 + 11 * i, link.m_cachedRotParentToThis, 4);
    put(15 + 11 * i, link.m_cachedRVector, 3);
  }
  return all;
}

// A tree that Bullet moves by one step from an arbitrary pose.
struct Move {
  explicit Move(double speed, unsigned seed = 1) : arbitrary(seed) {
    body = arbitraryRobot(arbitrary, robotOfAllJoints(speed));
    tree = std::make_unique<AmbientTree>(*body);
    TreeStep& step = tree->step;
    step.to_base = body->getWorldToBaseRot();
    readVelocity(*body, step.moved);
    body->stepPositionsMultiDof(bt(kPoseStep));
  }
  Arbitrary arbitrary;
  std::unique_ptr<btMultiBody> body;
  std::unique_ptr<AmbientTree> tree;
};

// Up to a turn of 1.3 rad in the step, of which Bullet makes pi/4.
TEST(TreePose, IsThatOfBulletUpToRounding) {
  for (const double speed : {1e-5, 0.1, 1.0, 10.0, 40.0}) {
    for (unsigned seed = 1; seed < 20; ++seed) {
      Move move(speed, seed);
      const Eigen::VectorXd expected = numbersOf(*move.body);
      settleTree(*move.tree, kPoseStep);
      EXPECT_LT((numbersOf(*move.body) - expected).cwiseAbs().maxCoeff(), kPoseRounding) << speed;
    }
  }
}

// Another sine, as another processor has it.
TEST(TreePose, DoesNotKeepBulletsLastBits) {
  Move move(1), other(1);
  settleTree(*other.tree, kPoseStep);
  const auto shift = [](btScalar& number) { number *= 1 + 2 * SIMD_EPSILON; };
  btMultiBody& body = *move.body;
  btQuaternion base = body.getWorldToBaseRot();
  shift(base[0]);
  body.setWorldToBaseRot(base);
  for (int i = 0; i < body.getNumLinks(); ++i) {
    btMultibodyLink& link = body.getLink(i);
    const bool is_planar = link.m_jointType == btMultibodyLink::ePlanar;
    if (is_planar || link.m_jointType == btMultibodyLink::eSpherical) shift(link.m_jointPos[1]);
    if (link.m_jointType == btMultibodyLink::eSpherical) link.updateCacheMultiDof();
    if (is_planar || link.m_jointType == btMultibodyLink::eRevolute) {
      shift(link.m_cachedRotParentToThis[0]);
      shift(link.m_cachedRVector[1]);
    }
  }
  EXPECT_NE(numbersOf(body), numbersOf(*other.body));
  settleTree(*move.tree, kPoseStep);
  EXPECT_EQ(numbersOf(body), numbersOf(*other.body));
}

TEST(TreePose, LeavesWhatOthersHaveMoved) {
  Move move(1);
  btMultiBody& body = *move.body;
  const btQuaternion turn(btVector3(1, 0, 0), bt(0.01));
  body.setWorldToBaseRot(turn * body.getWorldToBaseRot());
  for (int i = 0; i < body.getNumLinks(); ++i) {
    btMultibodyLink& link = body.getLink(i);
    btScalar* p = link.m_jointPos;
    if (link.m_jointType == btMultibodyLink::eSpherical) {
      const btQuaternion turned = turn * btQuaternion(p[0], p[1], p[2], p[3]);
      for (int k = 0; k < 4; ++k) p[k] = turned[k];
    } else {
      for (int k = 0; k < link.m_posVarCount; ++k) p[k] += bt(0.01);
    }
    link.updateCacheMultiDof();
  }
  const Eigen::VectorXd moved = numbersOf(body);
  settleTree(*move.tree, kPoseStep);
  EXPECT_LT((numbersOf(body) - moved).cwiseAbs().maxCoeff(), kPoseRounding);
}

// Colliders follow.
TEST(TreePose, MovesTheColliders) {
  Arbitrary arbitrary(2);
  RobotWorld world;
  RobotDef def = robotOfAllJoints(2);
  def.collider_radius = 0.01;
  btMultiBody& body = world.add(arbitrary, def);
  putIntoFluid(arbitrary, world, body, 2);
  world.step(kPoseStep, 50);
  for (int i = -1; i < body.getNumLinks(); ++i) {
    const btMultiBodyLinkCollider* collider =
        i < 0 ? body.getBaseCollider() : body.getLinkCollider(i);
    const btTransform before = collider->getWorldTransform();
    RobotWorld::moveColliders(body);
    EXPECT_EQ(before, collider->getWorldTransform()) << i;
  }
}

}  // namespace
}  // namespace ambient::test
