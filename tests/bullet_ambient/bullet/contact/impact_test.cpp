#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"
#include "tests/bullet_ambient/bullet/contact/uneven_body.h"

namespace ambient::test {
namespace {

// An ambient body that slides on a plane, an ordinary and an ambient body. The reference is exact;
// tolerances are rounding.

template <class Kind>
class Impact : public ::testing::Test {};
TYPED_TEST_SUITE(Impact, AllSolvers, SolverName);

// Friction sticks in both, one or none of the two directions, depending on the pair.
TYPED_TEST(Impact, WithBoxFrictionEqualsTheDenseSolution) {
  Arbitrary arbitrary(33);
  double worst = 0, worst_point_force = 0;
  int sticking = 0, sliding = 0;
  for (int i = 0; i < 300; ++i) {
    ContactPair pair = arbitraryPair(arbitrary, kOthers[i % 3]);
    const btContactSolverInfo info = convergingSettings(gyroscopicTime(pair, 0.05));
    pushAtRandom(arbitrary, pair, info.m_timeStep);
    pair.point().m_combinedFriction = btScalar(arbitrary.between(0.05, 0.6));
    const Before before(pair);
    const auto bodies = pair.dense(info.m_timeStep);
    const auto rows = pair.frictionRows(0, kFrictionBound<TypeParam>, info.m_timeStep);
    const auto expected = reference::onlySolution(bodies, rows);
    if (!expected || !(expected->impulses[0] > 1e-9)) continue;
    if (!pair.template solve<TypeParam>(info)) continue;
    for (int t : {1, 2}) {
      const Real bound =
          rows[t].normal_row < 0 ? rows[t].upper : rows[t].friction * expected->impulses[0];
      ++(std::abs(expected->impulses[t]) < bound * (1 - 1e-12L) ? sticking : sliding);
    }
    worst = std::max(worst, worstError(pair, *expected, before));

    // The wrench of the velocity change must act through the contact point. Its residual torque, as
    // a velocity of the body, is the error.
    const DenseVector6 wrench = bodies[0].inertia * (pair.a().velocity() - bodies[0].free_velocity);
    DenseVector6 of_force = wrench;
    of_force.head<3>() = pair.fromA().cross(Vector3r(wrench.tail<3>()));
    const DenseVector6 moved =
        pair.a().velocity() + reference::solved(bodies[0].inertia, of_force - wrench);
    worst_point_force = std::max(worst_point_force, pair.a().error(moved, before.a));
  }
  EXPECT_GT(sticking, 100);
  EXPECT_GT(sliding, 100);
  // Direct solvers reach 2e-6 in float. Iterative ones do, too, except for one
  // pair of slow convergence: 2.5e-5, probably rounding of thousands of
  // iterations.
  constexpr bool kIterates = !std::is_same_v<typename TypeParam::Base, btMLCPSolver>;
  EXPECT_LT(worst, kIterates && sizeof(btScalar) == 4 ? 3 * kTolerance : kTolerance);
  EXPECT_LT(worst_point_force, kTolerance);
}

// Two free bodies of 25 to 10 000 kg/m3 collide in an ideal fluid. Linear momentum of
// bodies and fluid must stay, except for the bound of eq. (31a) in large turns per
// step.

class Collision {
 public:
  Collision(unsigned seed, double speed) : arbitrary_(seed) {
    scene_.fluid.setReport(nullptr);  // bodies so light rise
    for (int i = 0; i < 2; ++i) bodies_[i] = &addBody(i, speed);
  }
  void step(double duration) { scene_.step(duration); }
  Vector3 momentum() const { return momentumOf(0) + momentumOf(1); }
  double size() const { return momentumOf(0).norm() + momentumOf(1).norm(); }
  bool hasMet() const { return scene_.fluid.counters().rows > 0; }

 private:
  Vector3 momentumOf(int i) const { return worldMomentum(scene_, *bodies_[i]).linear; }
  btRigidBody& addBody(int i, double speed) {
    const double x = arbitrary_.between(0.1, 0.4), y = arbitrary_.between(0.1, 0.4);
    const Vector3 axes(x, y, arbitrary_.between(0.1, 0.4));
    shapes_[i].setLocalScaling(toBullet(axes));
    BodyDef def;
    def.mass = 500 * std::exp(arbitrary_.between(-3, 3)) * ellipsoidVolume(axes);
    def.moments = ellipsoidMoments(axes, def.mass);
    def.shape = &shapes_[i];
    def.start.orientation = Quaternion(arbitrary_.rotation());
    def.start.position.x() = 1.4 * i;
    def.start.position.y() = arbitrary_.between(-0.1, 0.1);
    def.start.position.z() = arbitrary_.between(-0.1, 0.1);
    def.start.twist = arbitrary_.twist(1, 0.1);
    def.start.twist.linear.x() += i == 0 ? speed : -speed;
    btRigidBody& body = scene_.add(def, facelessEllipsoid(axes), idealFluid(1000));
    body.setRestitution(bt(0.3));
    return body;
  }

  Arbitrary arbitrary_;
  btBoxShape shapes_[2] = {btBoxShape({1, 1, 1}), btBoxShape({1, 1, 1})};
  FluidWorld scene_;
  btRigidBody* bodies_[2];
};

struct Losses {
  double mean = 0, worst = 0;  ///< relative to the sum of both initial momenta
};

Losses lossesOf(double speed, double rate) {
  constexpr int kCollisions = 40;
  Losses losses;
  int met = 0;
  for (unsigned seed = 0; seed < kCollisions; ++seed) {
    Collision collision(seed, speed);
    const Vector3 start = collision.momentum();
    const double size = collision.size();
    double worst = 0;
    for (int i = 0; i < 1.5 * rate; ++i) {
      collision.step(1 / rate);
      worst = std::max(worst, (collision.momentum() - start).norm() / size);
    }
    met += collision.hasMet();
    losses.mean += worst / kCollisions;
    losses.worst = std::max(losses.worst, worst);
  }
  EXPECT_GT(met, kCollisions * 3 / 4);
  return losses;
}

// Regression: without the correction (31b) of spin, 2 m/s at 60 Hz lost up to 8 %.
TEST(Collision, KeepsTheMomentumWhereTurnsAreSlow) {
  EXPECT_LT(lossesOf(2, 60).worst, byPrecision(1e-12, 1e-5));
  EXPECT_LT(lossesOf(3, 240).worst, byPrecision(1e-12, 1e-5));
}

// Turns up to 0.7, 0.9 and 2 rad per step. Losses before eq. (31b): 7, 15 and 15 %.
TEST(Collision, LosesLittleOfTheMomentumWhereTurnsAreFast) {
  const Losses slow = lossesOf(1, 30), fast = lossesOf(3, 60), coarse = lossesOf(2, 30);
  EXPECT_LT(slow.worst, 0.01);
  EXPECT_LT(slow.mean, 0.0005);
  EXPECT_LT(fast.worst, 0.03);
  EXPECT_LT(fast.mean, 0.002);
  EXPECT_LT(coarse.worst, 0.06);
  EXPECT_LT(coarse.mean, 0.005);
}

}  // namespace
}  // namespace ambient::test
