#include "bullet_ambient/fluid_body/octahedral_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/bodies/random_bodies.h"

namespace ambient {
namespace {

double shareOf(const OctahedralLattice::Place& place, int node) {
  double share = 0;
  for (int corner = 0; corner < 3; ++corner)
    if (place.node[corner] == node) share += place.share[corner];
  return share;
}

TEST(OctahedralLattice, HasEveryDirectionOnceAndFindsItAgain) {
  for (const int subdivisions : {1, 2, 3, 4, 7}) {
    const OctahedralLattice lattice(subdivisions);
    ASSERT_EQ(lattice.size(), 4 * subdivisions * subdivisions + 2);
    for (int node = 0; node < lattice.size(); ++node) {
      const Vector3 s = lattice.direction(node);
      EXPECT_NEAR(s.norm(), 1, 1e-15);
      EXPECT_NEAR(shareOf(lattice.placeOf(s), node), 1, 1e-12) << subdivisions << ", " << node;
      const Vector3 point = s * (subdivisions / s.cwiseAbs().sum());
      EXPECT_LT((point - Vector3(point.array().round())).norm(), 1e-12);
    }
  }
}

// Interpolation must reproduce linear functions exactly, on each of the eight faces.
TEST(OctahedralLattice, SharesAreLinearOnTheOctahedron) {
  test::Arbitrary arbitrary(1);
  for (const int subdivisions : {1, 4, 5}) {
    const OctahedralLattice lattice(subdivisions);
    for (int i = 0; i < 1000; ++i) {
      const Vector3 direction = arbitrary.vector();
      const OctahedralLattice::Place place = lattice.placeOf(direction);
      Vector3 mean = Vector3::Zero();
      for (int corner = 0; corner < 3; ++corner) {
        ASSERT_GE(place.node[corner], 0);
        ASSERT_LT(place.node[corner], lattice.size());
        EXPECT_GE(place.share[corner], -1e-12);
        const Vector3 s = lattice.direction(place.node[corner]);
        mean += place.share[corner] * s / s.cwiseAbs().sum();
      }
      EXPECT_LT((mean - direction / direction.cwiseAbs().sum()).norm(), 1e-14);
    }
  }
}

TEST(OctahedralLattice, AxesEdgesAndCornersOfItsFacesAreNoExceptions) {
  const OctahedralLattice lattice(4);
  for (const double x : {-1.0, -0.5, -0.0, 0.0, 1e-17, 0.5, 1.0})
    for (const double y : {-1.0, -1e-17, 0.0, 1.0 / 3, 1.0})
      for (const double z : {-1.0, 0.0, 1e-300, 1.0}) {
        const Vector3 direction(x, y, z);
        if (direction.isZero(0)) continue;
        const OctahedralLattice::Place place = lattice.placeOf(direction);
        EXPECT_NEAR(place.share[0] + place.share[1] + place.share[2], 1, 1e-14);
        for (const int node : place.node) {
          EXPECT_GE(node, 0);
          EXPECT_LT(node, lattice.size());
        }
      }
}

}  // namespace
}  // namespace ambient
