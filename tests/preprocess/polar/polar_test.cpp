#include "preprocess/polar/polar.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "tests/support/bodies/named_parts.h"

namespace ambient::test {
namespace {

/// Slope of C_m over the angle of attack about F's origin, on area and length 1, without friction.
double pitchSlope(const FluidBody& body) {
  PolarFlight flight;
  flight.reference = {1, 1};
  flight.added_mass = body.added_mass.bottomRightCorner<3, 3>();
  const BodyLoads loads(body, {1, 0, Vector3::Zero(), Vector3::Zero()}, {});
  constexpr double kAttack = 0.5 * kPi / 180;
  return (polarCoefficients(loads, flight, kAttack, 0)[4] -
          polarCoefficients(loads, flight, -kAttack, 0)[4]) /
         (2 * kAttack);
}

/// A spindle along x of 0.1 m across and 0.8 m long.
Named hull() { return {"hull", makeEllipsoidMesh({0.4, 0.05, 0.05}, 2000)}; }

// Munk 1924: the moment of an ideal fluid is 2 (k2 - k1) Vol per dynamic pressure and radian, nose
// up. Airships are said to keep 0.7 to 0.9 of it, docs/reality_runs.md.
TEST(Polar, OfASlenderHullHasTheUnstableMomentOfMunk) {
  const FluidBody body = built({hull()}, "none");
  const double k1 = body.added_mass(3, 3) / body.volume, k2 = body.added_mass(5, 5) / body.volume;
  EXPECT_NEAR(k1, 0.029, 0.002) << "Lamb, of 8 : 1";
  EXPECT_NEAR(k2, 0.945, 0.005);
  const double munk = 2 * (k2 - k1) * body.volume;
  EXPECT_GT(pitchSlope(body), 0.7 * munk);
  EXPECT_LT(pitchSlope(body), munk);
}

TEST(Polar, OfTheHullWithFinsIsStable) {
  std::vector<Named> parts{hull()};
  for (int k = 0; k < 4; ++k)
    parts.push_back({"fin_" + std::to_string(k),
                     placed(box({-0.36, 0.005, -0.001}, {-0.28, 0.115, 0.001}),
                            turnAbout(Eigen::Vector3d::UnitX(), k * kPi / 2), {0, 0, 0})});
  EXPECT_LT(pitchSlope(built(parts, "auto")), 0);
  EXPECT_GT(pitchSlope(built(parts, "none")), 0) << "as one part the fins do little";
}

}  // namespace
}  // namespace ambient::test
