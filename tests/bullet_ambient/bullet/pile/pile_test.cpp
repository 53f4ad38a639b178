#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/bullet_ambient/bullet/fluid_world.h"
#include "tests/bullet_ambient/bullet/pile/pile_scene.h"
#include "tests/support/convergence.h"

namespace ambient::test {
namespace {

constexpr int kMinute = 60 * 120;  // steps

// Limit of slip: every box keeps its place. Slip is random: 0.016 to 0.05 m in stock piles of
// different seeds.
constexpr double kPlace = 2 * Pile::kHalfEdge;

// Results of one pile after a minute.
struct Minute {
  double first_energy = 0, last_energy = 0;
  double highest_energy = 0;
  double largest_rise = 0;   ///< rise of energy above any earlier value
  double asleep_after = -1;  ///< [s]; -1: never
  double largest_shift = 0;  ///< box to its place in the cube [m]
  bool has_stirred = false;  ///< true: a box moved after all slept
};

std::vector<btVector3> places(const Pile& pile) {
  std::vector<btVector3> origins;
  for (const auto& box : pile.boxes()) origins.push_back(box->getWorldTransform().getOrigin());
  return origins;
}

double largestShift(const std::vector<btVector3>& a, const std::vector<btVector3>& b) {
  btScalar largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).length());
  return static_cast<double>(largest);
}

Minute observe(Pile& pile) {
  Minute minute;
  minute.first_energy = minute.highest_energy = pile.energy();
  EnergyRise rise(minute.first_energy);
  const std::vector<btVector3> start = places(pile);
  std::vector<btVector3> at_rest;
  for (int i = 0; i < kMinute; ++i) {
    pile.step(kWorldStep);
    if (minute.asleep_after < 0) {
      const double energy = pile.energy();
      minute.highest_energy = std::max(minute.highest_energy, energy);
      rise.see(energy);
      if (pile.isAsleep()) {
        minute.asleep_after = i * kWorldStep;
        at_rest = places(pile);
      }
    }
  }
  minute.largest_rise = rise.overEarlier();
  minute.last_energy = pile.energy();
  minute.largest_shift = largestShift(places(pile), start);
  minute.has_stirred = at_rest.empty() || largestShift(places(pile), at_rest) > 0;
  return minute;
}

Minute stockMinute() {
  Pile pile;
  return observe(pile);
}

Minute ambientMinute(PileFluid fluid) {
  Pile pile(1, fluid);
  return observe(pile);
}

class PileOfCoupledBoxes : public ::testing::TestWithParam<PileFluid> {};

// Bullet pushes overlapping bodies apart, which lifts a landing pile slightly. So the test compares
// the rise of energy with stock Bullet's.
TEST_P(PileOfCoupledBoxes, RestsAndSleepsAsStillAsInStockBullet) {
  const Minute stock = stockMinute();
  const Minute ambient = ambientMinute(GetParam());
  ASSERT_GT(stock.asleep_after, 0);
  EXPECT_FALSE(stock.has_stirred);

  EXPECT_GT(ambient.asleep_after, 0);
  EXPECT_LT(ambient.asleep_after, 1.05 * stock.asleep_after);
  EXPECT_FALSE(ambient.has_stirred);
  EXPECT_LT(stock.largest_shift, kPlace);
  EXPECT_LT(ambient.largest_shift, kPlace);
  EXPECT_LE(ambient.highest_energy, ambient.first_energy);
  EXPECT_LT(ambient.last_energy, ambient.first_energy);
  EXPECT_LE(ambient.largest_rise, 1.05 * stock.largest_rise);
}

INSTANTIATE_TEST_SUITE_P(Fluids, PileOfCoupledBoxes,
                         ::testing::Values(PileFluid{0.01, 0}, PileFluid{0.5, 0.2},
                                           PileFluid{10, 0.5}));

// Tells if friction remains on an open contact. Bullet's iterations keep friction of contacts that
// have opened, and may push a body by it.
bool hasFrictionWithoutContact(btDiscreteDynamicsWorld& world) {
  btDispatcher& dispatcher = *world.getDispatcher();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(i);
    for (int c = 0; c < manifold.getNumContacts(); ++c) {
      const btManifoldPoint& point = manifold.getContactPoint(c);
      if (point.m_appliedImpulse == 0 && point.m_appliedImpulseLateral1 != 0) return true;
    }
  }
  return false;
}

// Largest relative rise of energy above any earlier value. Boxes tumble on a plane until they rest;
// no position correction.
double largestRiseOfTumblingBoxes(double step) {
  const PileFluid fluid{2, 0.3};
  double largest = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    PileDef def;
    def.edge = 1;
    def.tilt = 1.5;
    def.height = 0.3;
    def.seed = seed;
    Pile pile(1, fluid, def);
    btContactSolverInfo& settings = pile.world().getSolverInfo();
    settings.m_erp = settings.m_erp2 = 0;
    settings.m_numIterations = 200;
    pile.keepAwake();
    const double first = pile.energy();
    EnergyRise rise(first);
    for (double time = 0; time < 5; time += step) {
      pile.step(step);
      const double energy = pile.energy();
      if (hasFrictionWithoutContact(pile.world())) rise.beginAt(energy);
      rise.see(energy);
    }
    EXPECT_LT(rise.lowest(), 0.7 * first) << "seed " << seed << " has not fallen";
    largest = std::max(largest, rise.overEarlier() / first);
  }
  return largest;
}

// Rows fix the velocity while the pose turns, and K in world axes with it: energy may rise at
// second order in the step.
TEST(TumblingCoupledBox, GainsNoMoreEnergyThanTheStepErrorOfSecondOrder) {
  const double coarse = largestRiseOfTumblingBoxes(1.0 / 120);
  const double fine = largestRiseOfTumblingBoxes(1.0 / 480);
  EXPECT_LT(coarse, 1e-4);
  EXPECT_LT(fine, coarse / 12);
}

}  // namespace
}  // namespace ambient::test
