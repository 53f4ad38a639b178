#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/motion/links/link_flight.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/bodies/random_trees.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::randomTree;
using test::TestTree;

// Loads of second order in the speed: |x| (G - D) x with G = -G^T and D >= 0.
class QuadraticLoads : public SurfaceLoads {
 public:
  QuadraticLoads(const Matrix6& drag, const Matrix6& lift, const Growth& growth = {})
      : drag_(drag), lift_(lift), growth_(growth) {}
  Wrench load(const Twist& x) const noexcept override {
    const Vector6 v = x.vector();
    return Wrench::fromVector(v.norm() * (lift_ * v - drag_ * v));
  }
  SplitLoad split(const Twist& x, const WetPart*) const noexcept override {
    return {load(x), growth_};
  }

 private:
  Matrix6 drag_, lift_;
  Growth growth_;
};

void setLoads(TestTree& test, int l, const Matrix6& drag, const Matrix6& lift) {
  BodyModel model = *test.tree.links[l].model;
  model.loads = std::make_shared<QuadraticLoads>(drag, lift);
  test.setModel(l, std::move(model));
}

void setResistance(TestTree& test, int l, const Matrix6& resistance, const Vector3& centre) {
  BodyModel model = *test.tree.links[l].model;
  const Matrix6 none = Matrix6::Zero();
  model.loads = std::make_shared<QuadraticLoads>(none, none, Growth{0.7, 1.3});
  giveResistance(model, std::make_shared<Resistance>(Resistance{resistance, centre}));
  test.setModel(l, std::move(model));
}

Matrix6 skew(Arbitrary& arbitrary) {
  Matrix6 G;
  for (Eigen::Index i = 0; i < G.size(); ++i) G.data()[i] = arbitrary.between(-1, 1);
  return G - G.transpose();
}

void setRandomLoads(Arbitrary& arbitrary, TestTree& test) {
  for (int l = 0; l < test.tree.size(); ++l) {
    if (l % 3 == 2) continue;  // some links without loads
    if (arbitrary.between(0, 1) < 0.3) {
      setResistance(test, l, std::pow(10, arbitrary.between(-6, 6)) * arbitrary.positiveDefinite(),
                    arbitrary.vector());
      continue;
    }
    setLoads(test, l, std::pow(10, arbitrary.between(-3, 3)) * arbitrary.positiveDefinite(),
             std::pow(10, arbitrary.between(-3, 3)) * skew(arbitrary));
  }
}

void setFlow(TestTree& test, const Vector3& flow) {
  for (Link& link : test.tree.links) link.surroundings.ambient_velocity = flow;
}

TEST(LinkKick, NeverGainsEnergyHoweverLongAndStrong) {
  Arbitrary arbitrary(1);
  for (int i = 0; i < 10000; ++i) {
    TestTree test = randomTree(arbitrary, {i % 4, i % 3 == 0, i % 2 == 0});
    setRandomLoads(arbitrary, test);
    const bool fixed = i % 5 == 0;
    Vector3 flow = arbitrary.vector(2);
    if (fixed) {
      test.tree.links[0].keeps_velocity = true;
      test.u.head<6>().setZero();
      flow.setZero();
    }
    setFlow(test, flow);
    Coordinates with_flow = Coordinates::Zero(test.u.size());
    with_flow.segment<3>(3) = flow;
    LinkDynamics dynamics(test.tree);
    LinkKick kick(test.tree);
    dynamics.setPose(test.pose);
    // Samples at another velocity, too: a quarter of it.
    kick.sample(dynamics, i % 7 ? test.u : (with_flow + 0.25 * (test.u - with_flow)).eval());
    const double before = dynamics.normSquared(test.u - with_flow);
    const double step =
        i % 2 ? arbitrary.between(1.0 / 240, 1.0 / 30) : std::pow(10, arbitrary.between(-6, 6));
    kick.kick(dynamics, step, test.u);
    ASSERT_TRUE(test.u.allFinite());
    ASSERT_LE(dynamics.normSquared(test.u - with_flow), before * (1 + 1e-12)) << i;
  }
}

TEST(LinkKick, IsTheLoadTimesTheTimeAtFirst) {
  Arbitrary arbitrary(2);
  for (const bool is_uniform : {true, false}) {
    TestTree test = randomTree(arbitrary, {4, true, true});
    for (int l = 0; l < 5; ++l) setLoads(test, l, arbitrary.positiveDefinite(), skew(arbitrary));
    setFlow(test, arbitrary.vector());
    if (!is_uniform) test.tree.links[2].surroundings.ambient_velocity = arbitrary.vector();
    LinkDynamics dynamics(test.tree);
    LinkKick kick(test.tree);
    dynamics.setPose(test.pose);
    kick.sample(dynamics, test.u);
    std::vector<Wrench> wrenches;
    for (int l = 0; l < 5; ++l)
      wrenches.push_back(test.tree.links[l].model->loads->load(dynamics.relativeTwist(l)));
    ASSERT_TRUE(dynamics.factor());
    Coordinates rate(test.u.size()), end = test.u;
    dynamics.respond(wrenches, rate);
    constexpr double kTime = 1e-7;
    kick.kick(dynamics, kTime, end);
    // Rates reach some thousand per second.
    EXPECT_LT((end - test.u - kTime * rate).norm(), 1e-3 * kTime * rate.norm());
  }
}

TEST(LinkKick, TakesLoadsToGrowWithTheSquareOfTheSpeed) {
  Arbitrary arbitrary(8);
  TestTree test = randomTree(arbitrary, {4, true, true});
  for (int l = 0; l < 5; ++l) setLoads(test, l, arbitrary.positiveDefinite(), skew(arbitrary));
  LinkDynamics dynamics(test.tree);
  LinkKick kick(test.tree);
  dynamics.setPose(test.pose);
  Coordinates sampled_here = test.u, sampled_slowly = test.u;
  kick.sample(dynamics, test.u);
  kick.kick(dynamics, 0.01, sampled_here);
  kick.sample(dynamics, 0.2 * test.u);
  kick.kick(dynamics, 0.01, sampled_slowly);
  EXPECT_LT((sampled_slowly - sampled_here).norm(), 1e-12 * test.u.norm());
  EXPECT_GT((sampled_here - test.u).norm(), 0.01 * test.u.norm());
}

// A chain under strong drag, where explicit forces would diverge: decay as with tiny steps.
TEST(LinkKick, FollowsTheDecayOfAChain) {
  const auto energyLeft = [](int steps) {
    Arbitrary arbitrary(4);
    TestTree test = randomTree(arbitrary, {3, false, false, 1, 1});
    for (int l = 0; l < 4; ++l) {
      const Matrix6& K = test.tree.links[l].model->inertia;
      setLoads(test, l, 10 * K, 0.2 * skew(arbitrary));
    }
    LinkFlight flight(test.tree);
    flight.dynamics().setPose(test.pose);
    const double start = flight.dynamics().kineticEnergy(test.u);
    test.fly(flight, 0.25 / steps, steps);
    flight.dynamics().setPose(test.pose);
    return flight.dynamics().kineticEnergy(test.u) / start;
  };
  const double exact = energyLeft(10000);
  EXPECT_NEAR(energyLeft(60) / exact, 1, 0.01);  // 240 Hz
  EXPECT_NEAR(energyLeft(15) / exact, 1, 0.03);  // 60 Hz
}

// A vane on a hinge in a current turns downstream and stays.
TEST(LinkKick, ALinkOfAFixedBaseComesToRestInACurrent) {
  Arbitrary arbitrary(5);
  TestTree test = randomTree(arbitrary, {1, false, false, 1, 1});
  Matrix6 drag = Matrix6::Zero();
  drag.diagonal() << 1e-3, 1e-3, 1e-3, 40, 40, 40;
  setLoads(test, 1, drag, Matrix6::Zero());
  Link& link = test.tree.links[1];
  test.tree.links[0].keeps_velocity = true;
  test.u.head<6>().setZero();
  const Vector3 flow(1, 0.5, -0.3);
  setFlow(test, flow);
  LinkFlight flight(test.tree);
  for (int i = 0; i < 60 * 60; ++i) ASSERT_TRUE(test.fly(flight, 1.0 / 60).is_finite);
  // Velocity between two kicks: second order in the step; the flow alone reaches 8 rad/s.
  EXPECT_LT(std::abs(test.u[6]), 1e-3);
  EXPECT_LT(std::abs(flight.meanVelocity()[6]), 1e-5);
  // No moment about the hinge: flow, hinge axis and arm to the link are coplanar.
  flight.dynamics().setPose(test.pose);
  const Matrix3& R = flight.dynamics().rotation(1);
  const Vector3 axis = R * link.joint.axes[0].head<3>(), arm = R * link.joint.pivot_to_link;
  EXPECT_NEAR(axis.cross(arm).normalized().dot(flow.normalized()), 0, 0.05);
}

// Flights that begin with the loads at the end of the one before evaluate each load once, and are
// as near to the exact motion as those that evaluate them at both ends.
TEST(LinkKick, RemembersLoadsFromFlightToFlight) {
  const auto flown = [](int steps, bool remembers) {
    Arbitrary arbitrary(9);
    TestTree test = randomTree(arbitrary, {3, true, true, 3, 0.3});
    std::vector<FlightMemory> memories(4);
    for (int l = 0; l < 4; ++l) {
      const Matrix6 K = test.tree.links[l].model->inertia;
      setLoads(test, l, K, 0.02 * skew(arbitrary));
      if (remembers) test.tree.links[l].memory = &memories[l];
    }
    LinkFlight flight(test.tree);
    const int first = test.fly(flight, 1.0 / steps).count.load_evaluations;
    const int last = test.fly(flight, 1.0 / steps, steps - 1).count.load_evaluations;
    EXPECT_EQ(first, 8);
    EXPECT_EQ(last, remembers ? 4 : 8);
    return test.u;
  };
  const Coordinates exact = flown(4000, false);
  const double error = (flown(120, false) - exact).norm();
  EXPECT_LT((flown(120, true) - exact).norm(), 1.3 * error);
  EXPECT_LT(error, 0.01 * exact.norm());
}

TEST(LinkKick, StaysBoundedInDifferentFlows) {
  Arbitrary arbitrary(6);
  for (int i = 0; i < 200; ++i) {
    TestTree test = randomTree(arbitrary, {3, i % 2 == 0, true});
    setRandomLoads(arbitrary, test);
    for (Link& link : test.tree.links) link.surroundings.ambient_velocity = arbitrary.vector();
    LinkDynamics dynamics(test.tree);
    LinkKick kick(test.tree);
    dynamics.setPose(test.pose);
    double motion = std::sqrt(dynamics.normSquared(test.u));
    for (int l = 0; l < 4; ++l)
      motion += std::sqrt(50 * test.tree.links[l].mass) * 6;  // some m/s of flow
    for (int k = 0; k < 100; ++k) {
      kick.sample(dynamics, test.u);
      kick.kick(dynamics, 1.0 / 60, test.u);
      ASSERT_LT(std::sqrt(dynamics.normSquared(test.u)), 10 * motion) << i;
    }
  }
}

TEST(LinkKick, AllocatesNothing) {
  Arbitrary arbitrary(7);
  TestTree test = randomTree(arbitrary, {5, true, true});
  setRandomLoads(arbitrary, test);
  LinkFlight flight(test.tree);
  const std::size_t before = test::allocationCount();
  for (int i = 0; i < 3; ++i) {
    flight.fly(test.pose, test.u, 1.0 / 60, {});
    flight.prepareJointRows();
    flight.computeRowVelocity(test.pose, test.u, 1.0 / 60);
  }
  EXPECT_EQ(test::allocationCount(), before);
}

}  // namespace
}  // namespace ambient
