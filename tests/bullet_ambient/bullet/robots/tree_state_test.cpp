#include "bullet_ambient/bullet/members/tree_state.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "bullet_ambient/motion/links/link_dynamics.h"
#include "tests/bullet_ambient/bullet/robots/robot_world.h"

// Flight with data read from a btMultiBody must move like Bullet without fluid.
namespace ambient::test {
namespace {

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
    RobotDef def;
    def.links = 10;
    def.joints = Joints::kAll;
    def.has_fixed_base = i % 2 == 0;
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
    RobotDef def;
    def.links = 8;
    def.joints = Joints::kSmooth;
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

}  // namespace
}  // namespace ambient::test
