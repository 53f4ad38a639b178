#include "bullet_ambient/force/surface/buoyancy.h"

#include <gtest/gtest.h>

#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

TEST(Buoyancy, IsTheWeightOfTheDisplacedFluidAtTheCentreOfVolume) {
  const Wrench f = buoyancy(2, {0.5, 0, 0}, {0, 0, -10});
  EXPECT_EQ(f.force, Vector3(0, 0, 20));
  EXPECT_EQ(f.torque, Vector3(0, -10, 0));
}

TEST(Buoyancy, IsTheHydrostaticPressureOverTheSurface) {
  // p = rho g.z at barycentres of flat triangles gives exact forces. The torque has a second-order
  // error from the variation of p within a triangle.
  test::Arbitrary arbitrary(61);
  const double rho = 1000;
  const Vector3 gravity(1, -2, -9);
  const FaceTable body = arbitrary.body(3);
  double volume = 0;
  Wrench pressure;
  for (std::size_t i = 0; i < body.size(); ++i) {
    const Vector3 n = body.normal(i);
    const Vector3 c = body.centroid(i);
    volume += body.area[i] * n.dot(c) / 3;
    pressure += Wrench::ofForceAt(-rho * gravity.dot(c) * body.area[i] * n, c);
  }
  const Vector3 force = buoyancy(rho * volume, Vector3::Zero(), gravity).force;
  EXPECT_LT((pressure.force - force).norm(), 1e-12 * force.norm());
}

TEST(Weight, ActsAtTheOriginWithoutTorque) {
  const Wrench f = weight(3, {0, 0, -10});
  EXPECT_EQ(f.force, Vector3(0, 0, -30));
  EXPECT_EQ(f.torque, Vector3::Zero());
}

TEST(Buoyancy, OfANeutralBodyCancelsItsWeight) {
  const Vector3 gravity(1, 2, -9);
  EXPECT_EQ((weight(3, gravity) + buoyancy(3, Vector3::Zero(), gravity)).vector(), Vector6::Zero());
}

}  // namespace
}  // namespace ambient
