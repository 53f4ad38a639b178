#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "tests/bullet_ambient/bullet/contact/uneven_body.h"

// Bodies at rest on a slope, kept awake, in Bullet's default mode of one friction row per contact.
// An uneven body slips in another direction than the push.
namespace ambient::test {
namespace {

constexpr double kSlope = 0.25, kSlopeFriction = 0.8, kSlopeStep = 1.0 / 60;
// Settling time: bodies little denser than water roll for seconds.
constexpr int kSettling = 600, kSliding = 540;

// A slope by oblique gravity on a level floor.
struct Slope : FluidWorld {
  explicit Slope(double angle = kSlope) {
    world.setGravity({bt(9.81 * std::sin(angle)), 0, bt(-9.81 * std::cos(angle))});
    floor.setFriction(1);
    world.addRigidBody(&floor);
  }
  ~Slope() { world.removeRigidBody(&floor); }

  void place(btRigidBody& body) {
    body.setGravity(world.getGravity());
    body.setFriction(bt(kSlopeFriction));
  }
  /// Distance moved after settling [m].
  double creep(const btRigidBody& body) {
    step(kSlopeStep, kSettling);
    const Vector3 start = readState(body).position;
    step(kSlopeStep, kSliding);
    return (readState(body).position - start).norm();
  }

  btCompoundShape tilted;  // shape of one body
  btConvexHullShape hull;
  btStaticPlaneShape plane{{0, 0, 1}, 0};
  btRigidBody floor{0, nullptr, &plane};
};

struct Worst {
  double ambient = 0, stock = 0;
};

// Largest creep of `count` bodies with fluid and without; `add` puts one into a world.
template <class Add>
Worst worstCreep(int count, const Add& add, int stock_mode = 0) {
  Worst worst;
  for (int seed = 0; seed < count; ++seed) {
    for (const bool in_fluid : {false, true}) {
      Slope slope;
      Arbitrary arbitrary(seed);
      if (!in_fluid) slope.world.getSolverInfo().m_solverMode |= stock_mode;
      btRigidBody& body = add(slope, arbitrary, in_fluid);
      slope.place(body);
      double& creep = in_fluid ? worst.ambient : worst.stock;
      creep = std::max(creep, slope.creep(body));
      slope.world.removeRigidBody(&body);
    }
  }
  return worst;
}

TEST(Slope, HoldsBoxesOfCoupledInertiaAsWellAsDryOnes) {
  btBoxShape box({bt(0.5), bt(0.4), bt(0.3)});
  const Worst worst =
      worstCreep(20, [&](Slope& slope, Arbitrary& arbitrary, bool in_fluid) -> btRigidBody& {
        BodyDef def{1, Vector3(0.25, 0.34, 0.41) / 3, {}, &box};
        def.start.position = {0, 0, 0.3};
        def.start.orientation = Eigen::AngleAxisd(arbitrary.between(0, 3), Vector3::UnitZ());
        return in_fluid ? slope.add(def, unevenFluid(arbitrary, 2), idealFluid(1)) : slope.add(def);
      });
  EXPECT_LT(worst.ambient, worst.stock);
}

// K is diagonal, oblique to the normal of the lower face. Stock Bullet has two friction rows here:
// dry boxes of equal moments creep by 0.3 mm, with one row by 0.01 mm.
TEST(Slope, HoldsBodiesThatStandOnATiltedFace) {
  btBoxShape box({bt(0.5), bt(0.4), bt(0.3)});
  const Worst worst = worstCreep(
      20,
      [&](Slope& slope, Arbitrary& arbitrary, bool in_fluid) -> btRigidBody& {
        BodyDef def{1, Vector3::Constant(0.12), {}, nullptr};
        const Quaternion tilt(
            Eigen::AngleAxisd(arbitrary.between(0.3, 1), arbitrary.vector().normalized()));
        slope.tilted.addChildShape(btTransform(toBullet(tilt)), &box);
        def.shape = &slope.tilted;
        def.start.position = {0, 0, 0.3};
        def.start.orientation = tilt.conjugate();
        Vector6 diagonal;
        diagonal << 0.1, 0.2, 0.1, 0.2, 0.5, 2;
        return in_fluid ? slope.add(def, inertiaAlone(diagonal.asDiagonal()), idealFluid(1))
                        : slope.add(def);
      },
      SOLVER_USE_2_FRICTION_DIRECTIONS);
  EXPECT_LT(worst.ambient, worst.stock);
}

// Adds an irregular body to the slope; its points are random.
btRigidBody& addHull(Slope& slope, Arbitrary& arbitrary, double density_ratio, bool in_fluid) {
  const Vector3 axes(0.3, 0.25, 0.15);
  for (int i = 0; i < 20; ++i)
    slope.hull.addPoint(toBullet(Vector3(arbitrary.vector().normalized().cwiseProduct(axes))));
  const double mass = density_ratio * water().density * ellipsoidVolume(axes);
  BodyDef def{mass, ellipsoidMoments(axes, mass), {}, &slope.hull};
  def.start.position = {0, 0, 0.2};
  btRigidBody& body = slope.add(def);
  if (!in_fluid) return body;
  AttachDef attach;
  attach.fluid_body = std::make_shared<FluidBody>(meshedEllipsoid(axes, 1));
  attach.medium = water();
  attach.fluid_frame.rotation =
      Quaternion(Eigen::AngleAxisd(0.3, arbitrary.vector().normalized())).toRotationMatrix();
  attach.fluid_frame.translation = arbitrary.vector(0.01);
  slope.fluid.add(body, attach);
  return body;
}

TEST(Slope, HoldsRandomHullsAsWellAsDryOnes) {
  for (const double density_ratio : {1.2, 2.7}) {
    const auto add = [&](Slope& slope, Arbitrary& arbitrary, bool in_fluid) -> btRigidBody& {
      return addHull(slope, arbitrary, density_ratio, in_fluid);
    };
    const Worst worst = worstCreep(6, add);
    EXPECT_LT(worst.ambient, worst.stock) << density_ratio;
  }
}

int contactsOf(btDispatcher& dispatcher) {
  int count = 0;
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i)
    count += dispatcher.getManifoldByIndexInternal(i)->getNumContacts();
  return count;
}

// Rows per contact in the first step of a box on the slope.
double rowsPerContact(double angle, const FluidBody& shape) {
  Slope slope(angle);
  btBoxShape box({bt(0.5), bt(0.4), bt(0.3)});
  BodyDef def{1, Vector3(0.25, 0.34, 0.41) / 3, {}, &box};
  def.start.position = {0, 0, 0.3};
  btRigidBody& body = slope.add(def, shape, idealFluid(1));
  slope.place(body);
  slope.step(kSlopeStep);
  const double rows = static_cast<double>(slope.of(body).counters().rows);
  const int contacts = contactsOf(*slope.world.getDispatcher());
  EXPECT_GT(contacts, 0);
  slope.world.removeRigidBody(&body);
  return rows / contacts;
}

TEST(Slope, CostsASecondRowOnlyWhereFrictionHoldsItAndThePushTurnsAside) {
  Arbitrary arbitrary(1);
  const FluidBody coupled = unevenFluid(arbitrary, 2);
  EXPECT_EQ(rowsPerContact(0, coupled), 2);
  EXPECT_EQ(rowsPerContact(0.005, coupled), 2);
  EXPECT_EQ(rowsPerContact(0.05, coupled), 3);
  EXPECT_EQ(rowsPerContact(0.95 * std::atan(kSlopeFriction), coupled), 3);
  EXPECT_EQ(rowsPerContact(1.05 * std::atan(kSlopeFriction), coupled), 2);
  Vector6 even;
  even << 0.1, 0.2, 0.1, 0.2, 0.5, 2;
  EXPECT_EQ(rowsPerContact(0.05, inertiaAlone(even.asDiagonal())), 2);
}

}  // namespace
}  // namespace ambient::test
