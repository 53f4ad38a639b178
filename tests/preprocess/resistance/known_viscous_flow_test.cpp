#include "preprocess/resistance/known_viscous_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bullet_ambient/base/pi.h"
#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"

namespace ambient {
namespace {

using Eigen::Vector3d;

TriangleMesh acrossWithVolume(TriangleMesh mesh, double volume) {
  mesh.vertices.topRows<2>() *= std::sqrt(volume / computeMassProperties(mesh).volume);
  return mesh;
}

/// Expects a table's R within `part` of that by panels, of the diagonal each number.
void expectSolved(const KnownViscousFlow& known, const TriangleMesh& mesh, double part) {
  ASSERT_TRUE(known.resistance);
  const Matrix6 R = computeStokesResistance(mesh);
  const Vector6 units = R.diagonal().cwiseSqrt();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR((*known.resistance)(i, j), R(i, j), part * units[i] * units[j])
          << i << " " << j << " of " << mesh.extents().transpose();
}

// Between the samples. Panels of default number are themselves up to 0.7 % off at edges.
TEST(KnownViscousFlow, ResistanceOfBoxesIsThatOfPanels) {
  for (const Vector3d& half :
       {Vector3d(1, 1.2, 1.5), Vector3d(1, 0.2, 4), Vector3d(0.3, 0.3, 0.02), Vector3d(9, 4, 2)})
    expectSolved(boxViscousFlow(half), makeBoxMesh(half, 12), 0.015);
}

TEST(KnownViscousFlow, ResistanceOfRoundBodiesIsThatOfPanels) {
  for (const double height : {0.05, 0.3, 1.1, 3.3, 12.0}) {
    const double r = 0.5;
    const Matrix6 cylinder = *cylinderAddedMass(r, height), capsule = *capsuleAddedMass(r, height);
    expectSolved(cylinderViscousFlow(r, height, cylinder),
                 acrossWithVolume(makeCylinderMesh(r, height, 400), kPi * r * r * height), 0.015);
    expectSolved(capsuleViscousFlow(r, height, capsule),
                 withVolume(makeCapsuleMesh(r, height, 400), kPi * r * r * (height + 4 * r / 3)),
                 0.01);
    expectSolved(coneViscousFlow(r, height),
                 acrossWithVolume(makeConeMesh(r, height, height < 2 ? 400 : 1200),
                                  kPi * r * r * height / 3),
                 0.015);
  }
}

TEST(KnownViscousFlow, GrowsWithTheSize) {
  const Matrix6 small = *coneViscousFlow(0.5, 2).resistance,
                large = *coneViscousFlow(2, 8).resistance;
  EXPECT_NEAR(large(5, 5) / small(5, 5), 4, 1e-12);
  EXPECT_NEAR(large(1, 3) / small(1, 3), 16, 1e-11);
  EXPECT_NEAR(large(0, 0) / small(0, 0), 64, 1e-11);
}

TEST(KnownViscousFlow, EndsWhereTheTablesEnd) {
  EXPECT_FALSE(boxViscousFlow({1, 1, 0.0099}).resistance);
  EXPECT_FALSE(coneViscousFlow(1, 201).resistance);
  EXPECT_TRUE(coneViscousFlow(1, 199).resistance);
}

/// Expects numbers within parts of those expected, of k also 0.02.
void expectLayers(const SeparationWay& found, const SeparationWay& expected) {
  EXPECT_NEAR(found.wake_laminar, expected.wake_laminar, 0.02 * expected.wake_laminar);
  EXPECT_NEAR(found.wake_bubble, expected.wake_bubble, 0.07 * expected.wake_bubble + 0.01);
  EXPECT_NEAR(found.wake_turbulent, expected.wake_turbulent, 0.07 * expected.wake_turbulent + 0.02);
  EXPECT_NEAR(found.wake_rough, expected.wake_rough, 0.03 * expected.wake_rough + 0.005);
  EXPECT_NEAR(found.thickness, expected.thickness, 0.02 * expected.thickness);
  EXPECT_NEAR(found.friction_laminar, expected.friction_laminar, 0.02 * expected.friction_laminar);
  EXPECT_NEAR(found.friction_bubble, expected.friction_bubble, 0.1 * expected.friction_bubble);
  EXPECT_NEAR(found.friction_turbulent, expected.friction_turbulent,
              0.02 * expected.friction_turbulent);
}

TEST(KnownViscousFlow, LayersOfEllipsoidsAreThoseOfTheirMesh) {
  for (const Vector3d& semi_axes : {Vector3d(1, 1, 1), Vector3d(0.5, 0.7, 1), Vector3d(4, 1, 1),
                                    Vector3d(2, 2, 1), Vector3d(6, 2, 1), Vector3d(1, 9, 5)}) {
    const Matrix6 added_mass = ellipsoidAddedMass(semi_axes).asDiagonal();
    const KnownViscousFlow known = ellipsoidViscousFlow(semi_axes, added_mass);
    const Separation mesh = ellipsoidSeparation(semi_axes, 8000);
    EXPECT_EQ(known.separation->axes, mesh.axes);
    EXPECT_EQ(known.separation->smooth_base, Vector3(1, 1, 1));
    for (std::size_t way = 0; way < 6; ++way) {
      SCOPED_TRACE(testing::Message() << semi_axes.transpose() << ", way " << way);
      expectLayers(known.separation->ways[way], mesh.ways[way]);
    }
    EXPECT_EQ(known.resistance->diagonal(), ellipsoidResistance(semi_axes));
  }
}

TEST(KnownViscousFlow, LayersOfCapsulesGoFromTheBallToTheCircle) {
  const auto capsule = [](double height) {
    return *capsuleViscousFlow(0.5, height, *capsuleAddedMass(0.5, height)).separation;
  };
  const Separation ball = sphereSeparation(), shortest = capsule(1e-6), longest = capsule(9.99);
  for (std::size_t way = 0; way < 6; ++way) expectLayers(shortest.ways[way], ball.ways[way]);
  Matrix3 axes;
  axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  const SeparationWay circle = cylinderSeparation(0.5, 10, axes).ways[2];
  EXPECT_NEAR(longest.ways[2].wake_laminar / circle.wake_laminar, 1, 0.1);
  EXPECT_NEAR(longest.ways[2].friction_turbulent / circle.friction_turbulent, 1, 0.1);
  EXPECT_EQ(longest.smooth_base, Vector3(1, 1, 1));
  EXPECT_EQ(longest.axes.col(0).cwiseAbs(), Vector3(0, 0, 1)) << "along: the least added mass";
  // Longer ones have the layers of the last.
  EXPECT_EQ(capsule(30).ways[0].wake_laminar, capsule(50).ways[0].wake_laminar);
}

TEST(KnownViscousFlow, EllipsoidsBeyondTheTableHaveFiniteLayers) {
  for (const Vector3d& semi_axes : {Vector3d(1000, 1, 1), Vector3d(1000, 1000, 1)}) {
    const KnownViscousFlow known =
        ellipsoidViscousFlow(semi_axes, ellipsoidAddedMass(semi_axes).asDiagonal());
    for (const SeparationWay& way : known.separation->ways) {
      EXPECT_GE(way.wake_bubble, 0);
      EXPECT_GT(way.thickness, 0);
      EXPECT_LT(way.wake_laminar, 200);
    }
  }
}

}  // namespace
}  // namespace ambient
