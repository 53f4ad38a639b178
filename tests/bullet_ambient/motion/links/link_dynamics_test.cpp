#include "bullet_ambient/motion/links/link_dynamics.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/reference/jointed_bodies.h"
#include "tests/support/bodies/random_trees.h"
#include "tests/support/matrices.h"

namespace ambient {
namespace {

using reference::JointedBody;
using reference::JointedReal;
using reference::JointedVector;
using test::Arbitrary;
using test::randomTree;
using test::TestTree;

JointedBody jointedBody(const Link& link, const JointPosition& position) {
  JointedBody b;
  b.mass = link.mass;
  b.moments = link.inertia.cast<JointedReal>();
  if (link.model) {
    Matrix6 added = link.model->inertia;
    added.diagonal() -= stack(link.inertia, Vector3::Constant(link.mass));
    b.added_mass = added.cast<JointedReal>();
    b.displaced_mass = link.model->displaced_mass;
    b.centre_of_volume = link.model->centre_of_volume.cast<JointedReal>();
    b.flow = link.surroundings.ambient_velocity.cast<JointedReal>();
    b.flow_acceleration = link.surroundings.ambient_acceleration.cast<JointedReal>();
    b.gravity = link.surroundings.gravity.cast<JointedReal>();
  }
  b.applied = link.surroundings.applied.vector().cast<JointedReal>();
  b.parent = link.parent;
  b.kind = static_cast<reference::JointedKind>(link.joint.kind);
  b.zero_rotation = link.joint.zero_axes.transpose().cast<JointedReal>();
  b.parent_to_pivot = link.joint.parent_to_pivot.cast<JointedReal>();
  b.pivot_to_body = link.joint.pivot_to_link.cast<JointedReal>();
  for (int i = 0; i < 3; ++i) {
    const bool is_way = link.joint.kind == JointKind::kPrismatic || i > 0;
    const Vector6& axis = link.joint.axes[i];
    b.axes[i] = (is_way ? axis.tail<3>() : axis.head<3>()).cast<JointedReal>();
    b.force[i] = link.joint_force[i];
  }
  for (int i = 0; i < 4; ++i) b.position[i] = position[i];
  return b;
}

// Converts the tree to bodies in maximal coordinates.
std::vector<JointedBody> jointedBodies(const TestTree& test) {
  std::vector<JointedBody> bodies;
  int next = 6;
  for (int l = 0; l < test.tree.size(); ++l) {
    const Link& link = test.tree.links[l];
    bodies.push_back(jointedBody(link, test.pose.joints[l]));
    for (int i = 0; l > 0 && i < axisCount(link.joint.kind); ++i)
      bodies.back().velocity[i] = test.u[next++];
  }
  JointedBody& base = bodies[0];
  base.rotation = test.pose.orientation.cast<JointedReal>().toRotationMatrix();
  base.origin = test.pose.position.cast<JointedReal>();
  base.w = test.u.head<3>().cast<JointedReal>();
  base.v = test.u.segment<3>(3).cast<JointedReal>();
  reference::placeBodies(bodies);
  return bodies;
}

void fixBase(TestTree& test) {
  test.tree.links[0].keeps_velocity = true;
  test.u.head<6>().setZero();
}

// Factored in the tree's pose.
LinkDynamics dynamicsOf(const TestTree& test) {
  LinkDynamics dynamics(test.tree);
  dynamics.setPose(test.pose);
  EXPECT_TRUE(dynamics.factor());
  return dynamics;
}

Coordinates accelerationsOf(const TestTree& test) {
  LinkDynamics dynamics = dynamicsOf(test);
  Coordinates a(dynamics.coordinates());
  dynamics.accelerations(test.u, a);
  return a;
}

double relativeError(const Coordinates& a, const JointedVector& b) {
  return static_cast<double>((a.cast<JointedReal>() - b).norm() / b.norm());
}

// Zeroes the acceleration in u of a base that keeps its twist; it has some in the world.
JointedVector expectedAccelerations(const TestTree& test) {
  const bool is_kept = test.tree.links[0].keeps_velocity;
  JointedVector a = reference::jointedAccelerations(jointedBodies(test), is_kept);
  if (is_kept) a.head<6>().setZero();
  return a;
}

// Checks twenty trees of five kinds of joints, with floating and fixed bases.
template <class Check>
void forTrees(const test::TreeShape& shape, const Check& check) {
  Arbitrary arbitrary(7);
  for (int i = 0; i < 20; ++i) {
    TestTree test = randomTree(arbitrary, shape);
    test::pushAround(arbitrary, test.tree);
    if (i % 2) fixBase(test);
    if (i % 4 == 1) test.u.head<6>() << 1, -2, 3, 2, 1, -1;  // kinematic base that turns
    SCOPED_TRACE(i);
    check(test, arbitrary);
  }
}

const test::TreeShape kTree{10, true, true};

void expectAccelerationsOfBodies(const test::TreeShape& shape) {
  forTrees(shape, [](const TestTree& test, Arbitrary&) {
    EXPECT_LT(relativeError(accelerationsOf(test), expectedAccelerations(test)), 1e-12);
  });
}

TEST(LinkDynamics, AcceleratesAsBodiesWithConstraintsDo) { expectAccelerationsOfBodies(kTree); }

TEST(LinkDynamics, LinksAreWhereTheirJointsPutThem) {
  forTrees(kTree, [](const TestTree& test, Arbitrary&) {
    LinkDynamics dynamics(test.tree);
    dynamics.setPose(test.pose);
    dynamics.setVelocity(test.u);
    const std::vector<JointedBody> bodies = jointedBodies(test);
    for (int l = 0; l < test.tree.size(); ++l) {
      const Matrix3 R = bodies[l].rotation.cast<double>();
      EXPECT_LT((dynamics.rotation(l) - R).norm(), 1e-14);
      EXPECT_LT((dynamics.position(l) - bodies[l].origin.cast<double>()).norm(), 1e-14);
      const Vector3 w = bodies[l].w.cast<double>(), v = bodies[l].v.cast<double>();
      EXPECT_LT((R * dynamics.twist(l).angular - w).norm(), 1e-13);
      EXPECT_LT((R * dynamics.twist(l).linear - v).norm(), 1e-13);
    }
  });
}

// Impulses at points of two links, like rows of contacts.
TEST(LinkDynamics, AnswersImpulsesAsBodiesWithConstraintsDo) {
  forTrees(kTree, [](const TestTree& test, Arbitrary& arbitrary) {
    LinkDynamics dynamics = dynamicsOf(test);
    std::vector<Wrench> wrenches(test.tree.size());
    const std::vector<JointedBody> bodies = jointedBodies(test);
    JointedVector impulses = JointedVector::Zero(6 * test.tree.size());
    for (int l : {3, test.tree.size() - 1}) {
      wrenches[l] = Wrench::ofForceAt(arbitrary.vector(), arbitrary.vector(0.1));
      impulses.segment<3>(6 * l) = bodies[l].rotation * wrenches[l].torque.cast<JointedReal>();
      impulses.segment<3>(6 * l + 3) = bodies[l].rotation * wrenches[l].force.cast<JointedReal>();
    }
    const bool fixed = test.tree.links[0].keeps_velocity;
    const JointedVector expected = reference::jointedResponse(bodies, fixed, impulses);
    Coordinates response(dynamics.coordinates());
    dynamics.respond(wrenches, response);
    EXPECT_LT(relativeError(response, expected), 1e-12);
    // Row J^T of the impulses: response per unit of each velocity.
    Coordinates row(dynamics.coordinates());
    for (int i = 0; i < row.size(); ++i) {
      dynamics.setVelocity(Coordinates::Unit(row.size(), i));
      row[i] = 0;
      for (int l = 0; l < test.tree.size(); ++l) row[i] += power(wrenches[l], dynamics.twist(l));
    }
    dynamics.respond(row, row);
    EXPECT_LT(relativeError(row, expected), 1e-12);
  });
}

TEST(LinkDynamics, MassMatrixMomentumAndNormAreOne) {
  forTrees(kTree, [](const TestTree& test, Arbitrary&) {
    LinkDynamics dynamics = dynamicsOf(test);
    const Eigen::MatrixXd H = dynamics.massMatrix();
    EXPECT_LT((H - H.transpose()).norm(), 1e-13 * H.norm());
    Coordinates a(dynamics.coordinates()), forces(dynamics.coordinates()), rest(a.size());
    dynamics.momentum(test.u, a);
    if (!test.tree.links[0].keeps_velocity) {
      EXPECT_LT((H * test.u - a).norm(), 1e-13 * a.norm());
    }
    EXPECT_NEAR(dynamics.normSquared(test.u), test.u.dot(a), 1e-13 * test.u.dot(a));
    // H du/dt = rhs; inverse dynamics gives both sides.
    dynamics.accelerations(test.u, a);
    dynamics.inverseDynamics(test.u, a, forces);
    dynamics.inverseDynamics(test.u, Coordinates::Zero(a.size()), rest);
    for (int l = 1; l < test.tree.size(); ++l) {
      for (int i = 0; i < axisCount(test.tree.links[l].joint.kind); ++i)
        EXPECT_NEAR(forces[dynamics.firstCoordinate(l) + i], test.tree.links[l].joint_force[i],
                    1e-11);
    }
    if (test.tree.links[0].keeps_velocity) forces.head<6>() = rest.head<6>();
    EXPECT_LT((H * a - (forces - rest)).norm(), 1e-12 * (forces - rest).norm());
  });
}

TEST(LinkDynamics, FixedJointsMakeOneBodyOfAllInertias) {
  Arbitrary arbitrary(3);
  TestTree test = randomTree(arbitrary, {4, false, true});
  for (int l = 1; l < 5; ++l)
    test.tree.links[l].joint = test::randomJoint(arbitrary, JointKind::kFixed);
  test.u.conservativeResize(6);
  LinkDynamics dynamics = dynamicsOf(test);
  Matrix6 K = test.tree.links[0].model->inertia;
  const Matrix3 R = test.pose.orientation.toRotationMatrix();
  for (int l = 1; l < 5; ++l) {
    const FrameOffset in_base{R.transpose() * dynamics.rotation(l),
                              R.transpose() * (dynamics.position(l) - test.pose.position)};
    K += in_base.inertiaToB(test.tree.links[l].model->inertia);
  }
  EXPECT_LT((dynamics.massMatrix() - rotateAxes(K, R)).norm(), 1e-13 * K.norm());
  // Kirchhoff's equations of a single body.
  const Twist x{R.transpose() * test.u.head<3>(), R.transpose() * test.u.segment<3>(3)};
  const Vector6 rate =
      test::solve(K, gyroscopicWrench(Momentum::fromVector(K * x.vector()), x).vector());
  Coordinates expected(6), a(6);
  expected << R * rate.head<3>(), R * (rate.tail<3>() + x.angular.cross(x.linear));
  dynamics.accelerations(test.u, a);
  EXPECT_LT((a - expected).norm(), 1e-12 * expected.norm());
}

TEST(LinkDynamics, LinksWithoutFluidDoNotFeelIt) {
  expectAccelerationsOfBodies({6, true, true, 0});
}

// Bullet's damping is a force on the dry mass. has_gyroscopic_term = false leaves out w x J w of
// the dry body.
TEST(LinkDynamics, DampsAndSpinsAsBulletDoes) {
  Arbitrary arbitrary(5);
  TestTree test = randomTree(arbitrary, {5, true, true});
  test.tree.linear_damping = 0.3;
  test.tree.angular_damping = 0.2;
  test.tree.has_gyroscopic_term = false;
  std::vector<JointedBody> bodies = jointedBodies(test);
  for (JointedBody& b : bodies) {
    const reference::JointedMatrix3 J =
        b.rotation * b.moments.asDiagonal() * b.rotation.transpose();
    b.applied.head<3>() -= 0.2L * (1 + b.w.norm()) * (J * b.w);
    b.applied.head<3>() += b.w.cross(J * b.w);
    b.applied.tail<3>() -= 0.3L * (1 + b.v.norm()) * b.mass * b.v;
  }
  EXPECT_LT(relativeError(accelerationsOf(test), reference::jointedAccelerations(bodies, false)),
            1e-12);
}

// A link that is kinematic with all its ancestors has a prescribed velocity, like the base.
TEST(LinkDynamics, KinematicLinksKeepTheirVelocity) {
  Arbitrary arbitrary(6);
  TestTree test = randomTree(arbitrary, {4});
  fixBase(test);
  test.tree.links[1].keeps_velocity = true;
  const double kept = test.u[6];
  LinkDynamics dynamics = dynamicsOf(test);
  Coordinates a(dynamics.coordinates()), response(dynamics.coordinates());
  dynamics.accelerations(test.u, a);
  EXPECT_EQ(a.head<7>().cwiseAbs().maxCoeff(), 0);
  dynamics.respond(Coordinates::Constant(a.size(), 1), response);
  EXPECT_EQ(response.head<7>().cwiseAbs().maxCoeff(), 0);
  // Frees the link: its force from inverse dynamics must give equal accelerations.
  Coordinates forces(a.size());
  dynamics.inverseDynamics(test.u, a, forces);
  test.tree.links[1].keeps_velocity = false;
  test.tree.links[1].joint_force[0] = forces[6];
  EXPECT_LT((accelerationsOf(test) - a).norm(), 1e-12 * a.norm());
  EXPECT_EQ(test.u[6], kept);
}

TEST(LinkDynamics, SaysWhereNoInertiaHoldsAJoint) {
  Arbitrary arbitrary(8);
  TestTree test = randomTree(arbitrary, {2, false, false, 0});
  test.tree.links[2].mass = 0;
  test.tree.links[2].inertia.setZero();
  LinkDynamics dynamics(test.tree);
  dynamics.setPose(test.pose);
  EXPECT_FALSE(dynamics.factor());
  for (Link& link : test.tree.links) link.keeps_velocity = true;  // nothing left to factor
  dynamics.setPose(test.pose);
  EXPECT_TRUE(dynamics.factor());
  for (Link& link : test.tree.links) link.keeps_velocity = false;
  test.tree.links[2].mass = std::numeric_limits<double>::quiet_NaN();
  dynamics.setPose(test.pose);
  EXPECT_FALSE(dynamics.factor());
}

TEST(LinkTree, RefusesWhatIsNoTree) {
  Arbitrary arbitrary(9);
  for (const int parent : {-1, 2, 7}) {
    TestTree test = randomTree(arbitrary, {3});
    test.tree.links[2].parent = parent;
    EXPECT_THROW(LinkDynamics{test.tree}, std::invalid_argument) << parent;
  }
  TestTree test = randomTree(arbitrary, {3});
  test.tree.links[1].mass = -1;
  EXPECT_THROW(LinkDynamics{test.tree}, std::invalid_argument);
}

}  // namespace
}  // namespace ambient
