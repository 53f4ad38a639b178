#include "tests/preprocess/table_generator/revolution_flow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "tests/reference/body_added_mass.h"

namespace ambient {
namespace {

// Trapezoidal rule: exponential convergence for periodic functions.
TEST(RingKernel, IsTheIntegralAroundTheRing) {
  const MeridianPoint target(0.8, 0.1), source(1.1, -0.3);
  const Eigen::Vector2d normal = Eigen::Vector2d(0.6, -0.8);
  double expected_source[2] = {}, expected_dipole[2] = {};
  constexpr int kSteps = 400;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2 * kPi * i / kSteps, c = std::cos(angle), s = std::sin(angle);
    const Eigen::Vector3d way(source.x() * c - target.x(), source.x() * s, source.y() - target.y());
    const Eigen::Vector3d n(normal.x() * c, normal.x() * s, normal.y());
    const double R = way.norm(), weight = 2 * kPi / kSteps / (4 * kPi);
    for (int m = 0; m < 2; ++m) {
      expected_source[m] += weight * std::cos(m * angle) / R;
      expected_dipole[m] -= weight * std::cos(m * angle) * n.dot(way) / (R * R * R);
    }
  }
  const RingKernel kernel = ringKernel(target, source, normal);
  for (int m = 0; m < 2; ++m) {
    EXPECT_NEAR(kernel.source[m], expected_source[m], 1e-13);
    EXPECT_NEAR(kernel.dipole[m], expected_dipole[m], 1e-12);
  }
}

// Half a ball: arc, line and sharp edge; all entries.
TEST(RevolutionFlow, OfHalfABallIsKnown) {
  const MeridianPiece dome{{0, 1}, {1, 0}, true, {0, 0}}, base{{1, 0}, {0, 0}};
  const RevolutionInertia K = solveRevolutionFlow({dome, base});
  const reference::RevolutionAddedMass exact = reference::hemisphereAddedMass();
  EXPECT_NEAR(K.v_z / exact.v_z, 1, 1e-5);
  EXPECT_NEAR(K.v_x / exact.v_x, 1, 1e-5);
  EXPECT_NEAR(K.w_y / exact.w_y, 1, 1e-5);
  EXPECT_NEAR(K.coupling / exact.coupling, 1, 1e-5);
}

TEST(Meridian, PiecesMeetAndLookOutwards) {
  for (const Meridian& meridian : {cylinderMeridian(1, 3), capsuleMeridian(1, 3),
                                   coneMeridian(1, 3, 0), coneMeridian(1, 3, 0.2)}) {
    EXPECT_EQ(meridian.front().begin.x(), 0);
    EXPECT_EQ(meridian.back().end.x(), 0);
    for (std::size_t i = 0; i < meridian.size(); ++i) {
      const MeridianPiece& piece = meridian[i];
      const MeridianPoint before = i > 0 ? meridian[i - 1].end : piece.begin;
      EXPECT_EQ((piece.begin - before).norm(), 0);
      EXPECT_NEAR((piece.at(1) - piece.end).norm(), 0, 1e-15);
      // Convex bodies around their origin: normals point away from it.
      EXPECT_GT(piece.normalAt(0.3).dot(piece.at(0.3)), 0);
    }
  }
}

}  // namespace
}  // namespace ambient
