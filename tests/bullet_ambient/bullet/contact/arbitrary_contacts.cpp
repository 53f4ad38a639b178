#include "tests/bullet_ambient/bullet/contact/arbitrary_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <utility>

namespace ambient::test {

double arbitraryRatio(Arbitrary& arbitrary) { return std::pow(10, arbitrary.between(-3, 4)); }

ContactPair arbitraryPair(Arbitrary& arbitrary, Other other) {
  CoupledBody a = CoupledBody::random(arbitrary, arbitraryRatio(arbitrary));
  const double ratio_b = other == Other::kAmbient ? arbitraryRatio(arbitrary) : 0;
  CoupledBody b =
      other == Other::kPlane ? CoupledBody::fixed() : CoupledBody::random(arbitrary, ratio_b);
  ContactPair pair(arbitrary, std::move(a), std::move(b));
  pair.makeApproaching();
  return pair;
}

double gyroscopicTime(const ContactPair& pair, double part) {
  const double dt = pair.a().gyroscopicTime(part);
  return pair.b().isFixed() ? dt : std::min(dt, pair.b().gyroscopicTime(part));
}

void pushAtRandom(Arbitrary& arbitrary, const ContactPair& pair, double dt) {
  for (const CoupledBody* body : {&pair.a(), &pair.b()}) {
    if (body->isFixed()) continue;
    const double push = 0.05 / (dt * static_cast<double>(body->body().getInvMass()));
    body->body().applyCentralForce(toBt(arbitrary.vector(push)));
    if (body->isAmbient()) body->body().applyTorque(toBt(arbitrary.vector(push * body->size())));
  }
}

double worstError(const ContactPair& pair, const reference::DenseSolution& expected,
                  const Before& before) {
  const double a = pair.a().error(expected.velocities[0], before.a);
  return pair.b().isFixed() ? a : std::max(a, pair.b().error(expected.velocities[1], before.b));
}

btContactSolverInfo convergingSettings(double dt) {
  btContactSolverInfo info = plainSettings(dt);
  info.m_numIterations = 4000;
  info.m_leastSquaresResidualThreshold = SIMD_EPSILON * SIMD_EPSILON;
  return info;
}

bool touch(const reference::DenseSolution& solution) {
  return solution.impulses.cwiseAbs().maxCoeff() > 1e-9L;
}

void report(const std::string& name, double error) {
  std::ostringstream text;
  text << std::setprecision(2) << error;
  ::testing::Test::RecordProperty(name, text.str());
  std::cout << "    largest error of " << name << ": " << text.str() << "\n";
}

}  // namespace ambient::test
