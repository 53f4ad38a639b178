#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <tuple>

#include "bullet_ambient/fluid_body/octahedral_lattice.h"
#include "bullet_ambient/force/surface/make_wetted_inertia.h"
#include "bullet_ambient/force/surface/wetted_parts.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

using test::Arbitrary;

Matrix6 arbitrarySymmetric(Arbitrary& arbitrary, double size) {
  Matrix6 matrix;
  for (int i = 0; i < 36; ++i) matrix(i) = size * arbitrary.between(-1, 1);
  return matrix + matrix.transpose();
}

/// An ellipsoid with parts, and a copy with a table of random corrections.
class Tabulated {
 public:
  Tabulated() {
    FluidBody body = test::floatingEllipsoid({1, 0.8, 0.6}, 2);
    plain_ = std::make_shared<const FluidBody>(body);
    body.waterline = {2, {0.1, 0.4, 1, 2}, {}};
    Arbitrary arbitrary(7);
    const double size = 0.05 * body.added_mass.maxCoeff();
    for (int i = 0; i < OctahedralLattice(2).size() * 4; ++i)
      body.waterline.corrections.push_back(arbitrarySymmetric(arbitrary, size));
    tabulated_ = std::make_shared<const FluidBody>(body);
    by_parts = makeWettedInertia(plain_);
    by_table = makeWettedInertia(tabulated_);
  }

  Immersion immersed(const Vector3& normal, double share) const {
    Immersion at{{normal.normalized(), 0, 1000, 9.81}, 0, 0, {}};
    const PackedHull hull(*plain_);
    std::tie(at.low, at.high) = computeExtent(hull, at.plane.normal);
    at.plane.height = at.low + share * at.size();
    at.wet = computeWetVolume(hull, at.plane);
    return at;
  }
  Matrix6 correction(const Vector3& normal, double share) const {
    const Immersion at = immersed(normal, share);
    return by_table->unraisedInertia(at) - by_parts->unraisedInertia(at);
  }
  const FluidBody& body() const { return *tabulated_; }
  const WaterlineTable& table() const { return tabulated_->waterline; }

 private:
  std::shared_ptr<const FluidBody> plain_, tabulated_;

 public:
  std::shared_ptr<const WettedInertia> by_parts, by_table;
};

TEST(WettedTable, AddsTheCorrectionsAtTheirNodes) {
  const Tabulated body;
  const OctahedralLattice lattice(body.table().subdivisions);
  for (int node = 0; node < lattice.size(); ++node)
    for (std::size_t i = 0; i < 4; ++i) {
      const Matrix6& expected = body.table().corrections[4 * node + i];
      const Matrix6 found = body.correction(lattice.direction(node), body.table().immersions[i]);
      EXPECT_LT((found - expected).norm(), 1e-11 * expected.norm()) << node << ", " << i;
    }
}

TEST(WettedTable, IsThatOfTheBodyWhereItIsDeepAndNothingWhereItIsDry) {
  const Tabulated body;
  const Vector3 s(1, -2, 3);
  EXPECT_EQ(body.by_table->inertia(body.immersed(s, 3.0001)), body.body().added_mass);
  EXPECT_EQ(body.by_table->inertia(body.immersed(s, -1e-4)), Matrix6::Zero());
  const double size = body.body().added_mass.norm();
  EXPECT_LT(body.correction(s, 2.9999).norm(), 1e-6 * size) << "the slope is 0 as well";
  EXPECT_LT(body.correction(s, 1e-6).norm(), 1e-4 * size);
}

TEST(WettedTable, GrowsWithTheSquareOfTheDepthFromTheTouchOn) {
  const Tabulated body;
  const Vector3 s(1, -2, 3);
  const double first = body.table().immersions.front();
  const Matrix6 there = body.by_table->unraisedInertia(body.immersed(s, first));
  const Matrix6 half = body.by_table->unraisedInertia(body.immersed(s, first / 2));
  EXPECT_LT((4 * half - there).norm(), 1e-13 * there.norm());  // a few roundings
  const Matrix6 above = body.by_table->unraisedInertia(body.immersed(s, first * (1 + 1e-9)));
  EXPECT_LT((above - there).norm(), 1e-6 * there.norm());
}

// Continuity in random directions, including borders between faces of the octahedron.
TEST(WettedTable, HasNoJumps) {
  const Tabulated body;
  Arbitrary arbitrary(3);
  const double size = body.body().added_mass.norm();
  for (int i = 0; i < 300; ++i) {
    Vector3 s = arbitrary.vector().normalized();
    if (i % 3 == 0) s[i % 9 / 3] = 0;
    const double share = i % 2 == 0 ? 1 : arbitrary.between(0.01, 2.9);
    const Matrix6 here = body.correction(s, share);
    const Vector3 aside = (s + 1e-8 * arbitrary.vector()).normalized();
    EXPECT_LT((body.correction(aside, share) - here).norm(), 1e-5 * size);
    EXPECT_LT((body.correction(s, share * (1 + 1e-8)) - here).norm(), 1e-5 * size);
  }
}

TEST(WettedTable, ItsGradientIsThatOfTheEnergyOverTheDepth) {
  const Tabulated body;
  Arbitrary arbitrary(5);
  for (int i = 0; i < 100; ++i) {
    const Vector3 s = arbitrary.vector();
    const double share = arbitrary.between(1.05, 2.95);  // planes without the rise of the water
    const Twist x = arbitrary.twist();
    const Vector6 v = x.vector();
    const double size = body.immersed(s, share).size(), step = 1e-5;
    const Matrix6 change = body.correction(s, share + step) - body.correction(s, share - step);
    const double expected = 0.5 * v.dot(change * v) / (2 * step * size);
    const Immersion at = body.immersed(s, share);
    const InertiaGradient with = body.by_table->gradient(at, x),
                          without = body.by_parts->gradient(at, x);
    const double scale = v.squaredNorm() * body.body().added_mass.norm();
    EXPECT_NEAR(with.by_height - without.by_height, expected, 1e-7 * scale);
    const Vector3 torque = at.plane.normal.cross(with.by_normal - without.by_normal);
    const Vector3 arm = at.wet.moment / at.wet.volume;
    EXPECT_LT((torque + expected * at.plane.normal.cross(arm)).norm(), 1e-6 * scale);
  }
}

}  // namespace
}  // namespace ambient
