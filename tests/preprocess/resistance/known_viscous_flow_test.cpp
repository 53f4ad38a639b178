#include "preprocess/resistance/known_viscous_flow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "preprocess/added_mass_tables/known_added_mass.h"
#include "preprocess/mesh/mass_properties.h"
#include "preprocess/mesh/shapes/primitives.h"
#include "preprocess/potential_flow/results/ellipsoid_added_mass.h"
#include "preprocess/potential_flow/results/refined_flow.h"
#include "preprocess/resistance/prepare.h"
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

const Matrix3 kAxes = Matrix3::Identity();

TEST(SurfaceNumbers, OfABallAreKnown) {
  const double r = 0.7;
  const SurfaceNumbers ball =
      computeSurfaceNumbers(makeEllipsoidMesh({r, r, r}, 20480), false, {}, kAxes);
  EXPECT_NEAR(ball.diameter / (2 * r), 1, 1e-3);
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(ball.frontal[j] / (kPi * r * r), 1, 1e-3) << j;
    EXPECT_NEAR(ball.moments[j] / (r * r / 3), 1, 1e-3) << j;
    EXPECT_NEAR(ball.gyration(j, j) / (2 * r * r / 3), 1, 1e-3) << j;
  }
}

TEST(SurfaceNumbers, OfABoxAreExact) {
  const Vector3 h(0.5, 1, 2);
  const SurfaceNumbers box = computeSurfaceNumbers(makeBoxMesh(h, 300), false, {}, kAxes);
  const double area = 8 * (h.x() * h.y() + h.y() * h.z() + h.z() * h.x());
  EXPECT_NEAR(box.diameter, std::sqrt(area / kPi), 1e-12);
  for (int j = 0; j < 3; ++j) {
    const int k = (j + 1) % 3, l = (j + 2) % 3;
    const double ends = 8 * h[k] * h[l], sides = area - ends;
    EXPECT_NEAR(box.frontal[j], ends / 2, 1e-12) << j;
    EXPECT_NEAR(box.moments[j], (ends + sides / 3) * h[j] * h[j] / area, 1e-12) << j;
  }
}

TEST(SurfaceNumbers, OfACylinderAreThoseOfTheFormula) {
  const double r = 0.5, L = 3, side = 2 * kPi * r * L, ends = 2 * kPi * r * r, area = side + ends;
  const SurfaceNumbers cylinder =
      computeSurfaceNumbers(makeCylinderMesh(r, L, 20000), false, {}, kAxes);
  EXPECT_NEAR(cylinder.moments.z() / ((L * L / 12 * side + L * L / 4 * ends) / area), 1, 3e-3);
  EXPECT_NEAR(cylinder.moments.x() / ((r * r / 2 * side + r * r / 4 * ends) / area), 1, 3e-3);
}

TEST(SurfaceNumbers, CountBothSidesOfASheet) {
  const SurfaceNumbers plate =
      computeSurfaceNumbers(makeRectangularSheetMesh(1, 2, 100), true, {}, kAxes);
  EXPECT_NEAR(plate.diameter, std::sqrt(4 / kPi), 1e-12);
  EXPECT_NEAR(plate.frontal.z(), 2, 1e-12);
  EXPECT_NEAR(plate.frontal.x(), 0, 1e-12);
}

TEST(SurfaceNumbers, TakeGyrationAboutTheCentreOfReaction) {
  const Vector3 centre(0.1, -0.2, 0.3);
  const TriangleMesh mesh = makeBoxMesh({0.5, 1, 2}, 300);
  const SurfaceNumbers near = computeSurfaceNumbers(mesh, false, {}, kAxes);
  const SurfaceNumbers beside = computeSurfaceNumbers(mesh, false, {{0, 0, 0}, centre}, kAxes);
  const Matrix3 change = centre.squaredNorm() * Matrix3::Identity() - centre * centre.transpose();
  EXPECT_LT((beside.gyration - near.gyration - change).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(beside.moments, near.moments);
}

TEST(SharpShare, IsOneOfEdgesAndPlates) {
  FormShape shape;
  shape.edges = 0;
  EXPECT_EQ(sharpShare(shape), 0);
  shape.edges = 0.45;
  EXPECT_NEAR(sharpShare(shape), 0.5, 1e-15);
  shape.wing = 0.5;
  EXPECT_NEAR(sharpShare(shape), 0.75, 1e-15);
  shape.edges = 1;
  EXPECT_EQ(sharpShare(shape), 1);
}

TEST(RefinedFlow, HasThePotentialsThatLayersNeed) {
  PotentialFlowSettings settings;
  settings.max_panels = 1000;
  const TriangleMesh mesh = makeEllipsoidMesh({2, 1, 1}, 1280);
  const RefinedFlow flow = solveRefinedFlow(mesh, settings);
  const Separation separation = computeSeparation(flow.surface, flow.potential.rightCols<3>(),
                                                  translationAxes(flow.added_mass))
                                    .separation;
  EXPECT_NEAR(separation.ways[0].wake_laminar / 0.9245, 1, 0.04);
  const RefinedFlow box = solveRefinedFlow(makeBoxMesh({0.5, 1, 2}, {1, 1, 1}), settings);
  const Separation edged =
      computeSeparation(box.surface, box.potential.rightCols<3>(), translationAxes(box.added_mass))
          .separation;
  EXPECT_LT(edged.smooth_base.maxCoeff(), 1e-6);
}

}  // namespace
}  // namespace ambient
