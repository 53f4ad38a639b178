#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "bullet_ambient/bullet/core/body_motion.h"
#include "bullet_ambient/bullet/links/tree_step.h"
#include "bullet_ambient/bullet/members/tree_state.h"
#include "bullet_ambient/motion/links/link_dynamics.h"
#include "bullet_ambient/robot_dynamics.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"
#include "tests/support/bodies/part_bodies.h"

namespace ambient::test {
namespace {

// Multibodies without joints fly as rigid bodies do, several side by side.

constexpr double kLoneHertz = 240;
constexpr double kLoneMass = 60;
const Vector3 kLoneSize(0.5, 0.3, 0.4);

btVector3 momentsOfBox() { return toBullet(boxMoments(kLoneSize, kLoneMass)); }

AttachDef loneInWater() {
  AttachDef def{std::make_shared<FluidBody>(floatingBox(kLoneSize)), water()};
  return def;
}

// Start of the box with a number.
btTransform placeAt(int number) {
  return btTransform(btQuaternion(btVector3(1, bt(0.5), 0), bt(0.3 * number)),
                     {bt(3 * number), 0, 0});
}
btVector3 spinAt(int number) { return {bt(0.2 * number), bt(-0.3), bt(0.1)}; }
btVector3 velocityAt(int number) { return {bt(0.5), bt(0.1 * number), 0}; }

/// Boxes without joints and colliders in water, under gravity.
class LoneBoxes {
 public:
  explicit LoneBoxes(const std::vector<int>& numbers) {
    world.world.setGravity({0, 0, bt(-9.81)});
    for (const int number : numbers) add(number);
  }
  ~LoneBoxes() {
    for (const auto& box : boxes) world.world.removeMultiBody(box.get());
  }

  RobotWorld world;
  std::vector<std::unique_ptr<btMultiBody>> boxes;

 private:
  void add(int number) {
    boxes.push_back(std::make_unique<btMultiBody>(0, bt(kLoneMass), momentsOfBox(), false, false));
    btMultiBody& box = *boxes.back();
    box.setLinearDamping(0);
    box.setAngularDamping(0);
    box.finalizeMultiDof();
    box.setBasePos(placeAt(number).getOrigin());
    box.setWorldToBaseRot(placeAt(number).getRotation().inverse());
    box.setBaseOmega(spinAt(number));
    box.setBaseVel(velocityAt(number));
    world.world.addMultiBody(&box);
    world.fluid.add(box, -1, loneInWater());
  }
};

TEST(MultibodiesWithoutJoints, FlyAsBodies) {
  LoneBoxes lone({2});
  btEmptyShape no_shape;
  btRigidBody rigid(
      btRigidBody::btRigidBodyConstructionInfo(bt(kLoneMass), nullptr, &no_shape, momentsOfBox()));
  rigid.setWorldTransform(placeAt(2));
  rigid.setAngularVelocity(spinAt(2));
  rigid.setLinearVelocity(velocityAt(2));
  lone.world.world.addRigidBody(&rigid);
  lone.world.fluid.add(rigid, loneInWater());
  lone.world.step(1 / kLoneHertz, static_cast<int>(5 * kLoneHertz));
  const btTransform a = rigid.getWorldTransform(), b = lone.boxes[0]->getBaseWorldTransform();
  EXPECT_LT((a.getOrigin() - b.getOrigin()).length(), bt(byPrecision(1e-10, 1e-3)));
  EXPECT_LT(a.getRotation().angleShortestPath(b.getRotation()), bt(byPrecision(1e-7, 1e-2)));
  EXPECT_GT((a.getOrigin() - placeAt(2).getOrigin()).length(), bt(0.3));
  EXPECT_EQ(lone.world.fluid.find(rigid)->counters().substeps,
            lone.world.fluid.find(*lone.boxes[0], -1)->counters().substeps);
  lone.world.world.removeRigidBody(&rigid);
}

TEST(MultibodiesWithoutJoints, HaveTheSameBitsInAnyCompany) {
  LoneBoxes all({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}), alone({9});
  for (LoneBoxes* boxes : {&all, &alone}) boxes->world.step(1 / kLoneHertz, 100);
  EXPECT_EQ(all.boxes[9]->getBasePos(), alone.boxes[0]->getBasePos());
  EXPECT_EQ(velocityOf(*all.boxes[9]), velocityOf(*alone.boxes[0]));
}

TEST(MultibodiesWithoutJoints, StepTogetherWithThoseOfOtherWorlds) {
  LoneBoxes all({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
  std::vector<std::unique_ptr<LoneBoxes>> worlds;
  std::vector<Fluid*> fluids;
  for (const std::vector<int>& numbers : {std::vector<int>{0, 1, 2}, {3}, {4, 5, 6, 7, 8, 9, 10}}) {
    worlds.push_back(std::make_unique<LoneBoxes>(numbers));
    fluids.push_back(&worlds.back()->world.fluid);
  }
  all.world.step(1 / kLoneHertz, 100);
  for (int n = 0; n < 100; ++n)
    stepTogether(fluids.data(), 3, [&](int i) { worlds[i]->world.step(1 / kLoneHertz); });
  std::size_t number = 0;
  for (const auto& world : worlds)
    for (const auto& box : world->boxes) {
      const btMultiBody& expected = *all.boxes[number++];
      EXPECT_EQ(box->getBasePos(), expected.getBasePos()) << number;
      EXPECT_EQ(velocityOf(*box), velocityOf(expected)) << number;
    }
}

// In an ideal fluid, turning by more in a step than Bullet turns a multibody.
TEST(MultibodiesWithoutJoints, KeepTheirEnergyThroughFastTurns) {
  LoneBoxes lone({1});
  btMultiBody& box = *lone.boxes[0];
  lone.world.fluid.clear();
  AttachDef def = loneInWater();
  def.flow.own_law = [](const auto&, const auto&) { return nullptr; };
  lone.world.fluid.add(box, -1, def);
  lone.world.world.setGravity({0, 0, 0});
  box.setBaseOmega({bt(1), bt(2), bt(100)});
  const double energy = kineticEnergy(lone.world.fluid, box);
  lone.world.step(1 / 60.0, 30);
  EXPECT_NEAR(kineticEnergy(lone.world.fluid, box) / energy, 1, byPrecision(1e-6, 1e-3));
}

// Flight with data read from a btMultiBody must move like Bullet without fluid.

Eigen::VectorXd accelerationOfBullet(btMultiBody& body) {
  btAlignedObjectArray<btScalar> scalars;
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btMatrix3x3> matrices;
  const Eigen::VectorXd before = velocityOf(body);
  body.computeAccelerationsArticulatedBodyAlgorithmMultiDof(1, scalars, vectors, matrices, false,
                                                            false, false);
  const Eigen::VectorXd change = velocityOf(body) - before;
  writeVelocity(body, before);
  return change;
}

void push(Arbitrary& arbitrary, btMultiBody& body) {
  body.addBaseForce(toBullet(arbitrary.vector()));
  body.addBaseTorque(toBullet(arbitrary.vector(0.1)));
  for (int i = 0; i < body.getNumLinks(); ++i) {
    body.addLinkForce(i, toBullet(arbitrary.vector()));
    body.addLinkTorque(i, toBullet(arbitrary.vector(0.1)));
    for (int k = 0; k < body.getLink(i).m_dofCount; ++k)
      body.addJointTorqueMultiDof(i, k, bt(arbitrary.between(-0.1, 0.1)));
  }
}

TEST(TreeState, MovesWithoutFluidAsInBullet) {
  Arbitrary arbitrary(1);
  double worst = 0;
  for (int i = 0; i < 40; ++i) {
    RobotWorld world;
    RobotDef def{10, Joints::kAll, i % 2 == 0};
    btMultiBody& body = world.add(arbitrary, def);
    push(arbitrary, body);
    body.setUseGyroTerm(i % 3 != 0);
    body.setLinearDamping(bt(i % 4 * 0.05));
    body.setAngularDamping(bt(i % 5 * 0.03));
    const LinkTree tree = makeLinkTree(body);
    TreePose pose;
    readPose(body, pose);
    LinkDynamics dynamics(tree);
    dynamics.setPose(pose);
    ASSERT_TRUE(dynamics.factor());
    Coordinates rate(dynamics.coordinates());
    dynamics.accelerations(velocityOf(body), rate);
    worst = std::max(worst, relativeError(rate, accelerationOfBullet(body)));
  }
  EXPECT_LT(worst, byPrecision(1e-12, 1e-3));
}

TEST(TreeState, MovesAsBulletDoes) {
  Arbitrary arbitrary(2);
  double worst = 0;
  for (int i = 0; i < 20; ++i) {
    RobotWorld world;
    RobotDef def{8, Joints::kSmooth};
    btMultiBody& body = world.add(arbitrary, def);
    const LinkTree tree = makeLinkTree(body);
    TreePose pose, expected;
    readPose(body, pose);
    movePose(tree, pose, velocityOf(body), 0.1, pose);
    body.stepPositionsMultiDof(bt(0.1));
    readPose(body, expected);
    worst = std::max({worst, (pose.position - expected.position).norm(),
                      pose.orientation.angularDistance(expected.orientation)});
    for (int link = 1; link < tree.size(); ++link) {
      const FrameOffset offset = linkOffset(tree.links[link].joint, pose.joints[link]);
      const btMultibodyLink& bullet = body.getLink(link - 1);
      const Matrix3 R = toQuaternion(bullet.m_cachedRotParentToThis).toRotationMatrix();
      worst = std::max({worst, (offset.rotation.transpose() - R).norm(),
                        (R * offset.translation - toVector3(bullet.m_cachedRVector)).norm()});
    }
  }
  EXPECT_LT(worst, byPrecision(1e-7, 1e-6));
}

TEST(TreeState, TellsAnotherOneByItsLinks) {
  Arbitrary arbitrary(3);
  RobotWorld world;
  const btMultiBody& one = world.add(arbitrary, {});
  const btMultiBody& other = world.add(arbitrary, {});
  RobotDef longer;
  longer.links = 4;
  EXPECT_TRUE(hasLinksOf(one, makeLinkTree(one)));
  EXPECT_FALSE(hasLinksOf(other, makeLinkTree(one)));
  EXPECT_FALSE(hasLinksOf(world.add(arbitrary, longer), makeLinkTree(one)));
}

constexpr double kPoseStep = 1.0 / 60;
const double kPoseRounding = byPrecision(1e-14, 1e-5);  // of numbers of size 1

RobotDef robotOfAllJoints(double speed) {
  RobotDef def{10, Joints::kAll};
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
