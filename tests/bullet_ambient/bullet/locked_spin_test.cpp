#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient::test {
namespace {

// Bodies that move in the x-y plane only, in an ideal fluid without gravity.
class PlanarBody {
 public:
  PlanarBody(unsigned seed, double spin) {
    Arbitrary arbitrary(seed);
    BodyDef def;
    def.moments = {0.4, 0.5, 0.6};
    def.start.twist.angular = {0, 0, spin};
    def.start.twist.linear = {arbitrary.between(-1, 1), arbitrary.between(-1, 1), 0};
    Medium fluid = water();
    fluid.density = 1;
    fluid.viscosity = 0;
    FluidBody shape;
    shape.name = "coupled";
    shape.added_mass = 2 * arbitrary.positiveDefinite();
    shape.volume = 1;
    shape.area = 1;
    body_ = &scene_.add(def, shape, fluid);
    body_->setLinearFactor({1, 1, 0});
    body_->setAngularFactor({0, 0, 1});
  }
  void step(double duration) { scene_.step(duration); }
  double energy() const {
    const Vector6 x = readState(*body_).twist.vector();
    return x.dot(scene_.of(*body_).inertia() * x) / 2;
  }
  bool isInPlane() const {
    return body_->getLinearVelocity().z() == 0 && body_->getAngularVelocity().x() == 0 &&
           body_->getAngularVelocity().y() == 0;
  }

 private:
  FluidWorld scene_;
  btRigidBody* body_;
};

struct EnergyRange {
  double lowest = 1, highest = 1, mean_end = 0;  ///< over the initial energy
};

// Energy range of twenty random bodies.
EnergyRange energyRange(double spin, double step, double duration) {
  constexpr unsigned kBodies = 20;
  EnergyRange range;
  for (unsigned seed = 0; seed < kBodies; ++seed) {
    PlanarBody body(seed, spin);
    const double start = body.energy();
    for (int i = 0; i < std::lround(duration / step); ++i) {
      body.step(step);
      EXPECT_TRUE(body.isInPlane()) << seed;
      range.lowest = std::min(range.lowest, body.energy() / start);
      range.highest = std::max(range.highest, body.energy() / start);
    }
    range.mean_end += body.energy() / start / kBodies;
  }
  return range;
}

TEST(LockedSpin, GainsNoEnergyBeyondARadianPerStep) {
  for (const double spin : {60, 300, 3000})
    EXPECT_LE(energyRange(spin, 1.0 / 60, 10).highest, 1 + byPrecision(1e-12, 1e-5)) << spin;
}

// Locks do work, by their directions at the start of a step; it alternates within each turn.
TEST(LockedSpin, KeepsEnergyToFirstOrderOfTheStep) {
  for (const double spin : {1, 3}) {
    const EnergyRange coarse = energyRange(spin, 1.0 / 60, 2),
                      fine = energyRange(spin, 1.0 / 120, 2);
    EXPECT_NEAR((coarse.highest - 1) / (fine.highest - 1), 2, 0.1) << spin;
    EXPECT_NEAR((1 - coarse.lowest) / (1 - fine.lowest), 2, 0.1) << spin;
  }
}

// 0.1 to 0.5 radian per step. Single bodies gain 9 % in 10 s at 10 rad/s before they lose
// energy.
TEST(LockedSpin, LosesEnergyOnAverageWhereStepsAreCoarse) {
  for (const double spin : {10, 30}) {
    const EnergyRange range = energyRange(spin, 1.0 / 60, 10);
    EXPECT_LT(range.mean_end, 1) << spin;
    EXPECT_LT(range.highest, 1.1) << spin;
  }
}

}  // namespace
}  // namespace ambient::test
