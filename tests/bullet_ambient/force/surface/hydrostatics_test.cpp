#include "bullet_ambient/force/surface/hydrostatics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bullet_ambient/base/pi.h"
#include "tests/support/bodies/geodesic.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/bodies/random_bodies.h"
#include "tests/support/bodies/round_barrel.h"

namespace ambient {
namespace {

using test::Arbitrary;
using test::boxBody;

SurfacePlane planeAt(const Vector3& normal, double height) {
  return {normal.normalized(), height, 1, 1};
}

TEST(Hydrostatics, BothSidesOfThePlaneMakeUpABox) {
  Arbitrary arbitrary(1);
  for (const int divisions : {1, 4}) {
    const PackedHull box(boxBody({2, 1, 0.5}, divisions));
    for (int i = 0; i < 200; ++i) {
      const SurfacePlane plane = planeAt(arbitrary.vector(), arbitrary.between(-1, 1));
      const WetVolume wet = computeWetVolume(box, plane);
      const WetVolume dry = computeWetVolume(box, plane.flipped());
      EXPECT_NEAR(wet.volume + dry.volume, 1, 1e-13);
      EXPECT_LT((wet.moment + dry.moment).norm(), 1e-13);
      // Expects int zeta over the whole box = V h.
      EXPECT_NEAR(wet.depth_integral - dry.depth_integral, plane.height, 1e-13);
      EXPECT_NEAR(wet.waterplane.area, dry.waterplane.area, 1e-13);
    }
  }
}

void expectSame(const WetVolume& wet, const WetVolume& expected) {
  EXPECT_NEAR(wet.volume, expected.volume, 1e-14);
  EXPECT_LT((wet.moment - expected.moment).norm(), 1e-14);
  EXPECT_NEAR(wet.depth_integral, expected.depth_integral, 1e-14);
  EXPECT_NEAR(wet.waterplane.area, expected.waterplane.area, 1e-14);
  constexpr double kSome = 1e-3;  // of less, rounding makes the centroid
  if (!(expected.waterplane.area > kSome)) return;
  EXPECT_LT((wet.waterplane.centroid - expected.waterplane.centroid).norm(), 1e-11);
  EXPECT_LT((wet.waterplane.spread - expected.waterplane.spread).norm(), 1e-14);
}

// A quarter of the triangles stands for all of them.
TEST(Hydrostatics, PartOfASymmetricHullIsAsGoodAsAllOfIt) {
  Arbitrary arbitrary(4);
  for (int axis = 0; axis < 3; ++axis)
    for (const bool has_equal_ends : {true, false}) {
      SCOPED_TRACE(axis);
      const FluidBody body = test::roundBarrel(axis, has_equal_ends);
      const PackedHull part(body), all(body.surface);
      ASSERT_EQ(part.blocks().symmetry.axis, axis);
      EXPECT_LE(part.blocks().count, all.blocks().count / 3);
      for (int i = 0; i < 100; ++i) {
        SurfacePlane plane = planeAt(arbitrary.vector(), arbitrary.between(-1.2, 1.2));
        expectSame(computeWetVolume(part, plane), computeWetVolume(all, plane));
        const auto [low, high] = computeExtent(part, plane.normal);
        const auto [lowest, highest] = computeExtent(all, plane.normal);
        EXPECT_NEAR(low, lowest, 1e-15);
        EXPECT_NEAR(high, highest, 1e-15);
        PoolSides sides;
        sides.count = 1;
        sides.of[0] = {plane.normal.cross(arbitrary.vector()).normalized(),
                       0.3 * arbitrary.vector()};
        plane.sides_F = &sides;
        expectSame(computeWetVolume(part, plane), computeWetVolume(all, plane));
        EXPECT_LT(
            (computeSidePush(part, plane).vector() - computeSidePush(all, plane).vector()).norm(),
            1e-13);
      }
    }
}

// A hull that is all but symmetric is kept whole.
TEST(Hydrostatics, ADentTakesTheSymmetryOfAHull) {
  FluidBody body = test::roundBarrel(2, true);
  body.surface.vertices[3 * 40] *= 0.999;
  makeSurfaceForm(body);
  EXPECT_EQ(PackedHull(body).blocks().symmetry.images(), 1);
  FluidBody turned = test::roundBarrel(2, true);
  std::vector<std::int32_t>& triangles = turned.surface.triangles.own();
  const std::size_t side = 3 * 8;  // its two triangles take the other diagonal
  const std::int32_t a = triangles[side], b = triangles[side + 1], c = triangles[side + 2],
                     d = triangles[side + 5];
  ASSERT_EQ(triangles[side + 3], a);
  const std::array<std::int32_t, 6> other{a, b, d, b, c, d};
  std::copy(other.begin(), other.end(), &triangles[side]);
  EXPECT_EQ(PackedHull(turned).blocks().symmetry.images(), 1);
}

// Twice the way has eight times the error: planes of 1e-2 and 2e-2 beside the first.
TEST(Hydrostatics, TheEnergyAtANearPlaneErrsToThirdOrder) {
  Arbitrary arbitrary(2);
  const PackedHull hull(test::bumpyBody(arbitrary));
  for (int i = 0; i < 50; ++i) {
    const SurfacePlane plane = planeAt(arbitrary.vector(), arbitrary.between(-0.5, 0.5));
    const WetVolume wet = computeWetVolume(hull, plane);
    const Vector3 turn = arbitrary.vector();
    const double rise = arbitrary.between(-1, 1);
    double errors[2] = {};
    for (const int k : {0, 1}) {
      const double way = 0.01 * (k + 1);
      const SurfacePlane near =
          planeAt(plane.normal + way * turn.normalized(), plane.height + way * rise);
      const double exact =
          hydrostaticEnergy(computeWetVolume(hull, near), near) - hydrostaticEnergy(wet, plane);
      errors[k] = std::abs(hydrostaticEnergyChange(wet, plane, near) - exact);
      EXPECT_LT(errors[k], 5 * way * way * way);
    }
    EXPECT_LT(errors[0], std::max(errors[1] / 4, 1e-7));
  }
}

TEST(Hydrostatics, UprightBoxHasItsWaterplaneAndCentreOfBuoyancy) {
  const double draught = 0.3;
  const PackedHull box(boxBody({2, 1, 0.5}));
  const WetVolume wet = computeWetVolume(box, planeAt({0, 0, 1}, draught - 0.25));
  EXPECT_NEAR(wet.volume, 2 * draught, 1e-15);
  EXPECT_NEAR(wet.moment.z(), 2 * draught * (draught / 2 - 0.25), 1e-15);
  EXPECT_NEAR(wet.depth_integral, 2 * draught * draught / 2, 1e-15);
  EXPECT_NEAR(wet.waterplane.area, 2, 1e-15);
  EXPECT_LT((wet.waterplane.centroid - Vector3(0, 0, draught - 0.25)).norm(), 1e-15);
  Matrix3 spread = Matrix3::Zero();
  spread.diagonal() << 2 * 4 / 12.0, 2 * 1 / 12.0, 0;
  EXPECT_LT((wet.waterplane.spread - spread).norm(), 1e-14);
}

TEST(Hydrostatics, CapOfASphereHasItsClosedForm) {
  const double R = 1.5;
  const Vector3 centre(0.3, -0.2, 0.5);
  Arbitrary arbitrary(2);
  for (int i = 0; i <= 20; ++i) {
    const double d = 2 * R * i / 20;  // depth of the lowest point
    const Vector3 s = arbitrary.vector().normalized();
    const SurfacePlane plane = planeAt(s, s.dot(centre) - R + d);
    const WetVolume wet = computeWetSphere(R, centre, plane);
    EXPECT_NEAR(wet.volume, kPi * d * d * (3 * R - d) / 3, 1e-13);
    EXPECT_NEAR(wet.depth_integral, kPi * d * d * d * (4 * R - d) / 12, 1e-13);
    EXPECT_NEAR(wet.waterplane.area, kPi * d * (2 * R - d), 1e-13);
    const double along = -3 * (2 * R - d) * (2 * R - d) / (4 * (3 * R - d));
    EXPECT_LT((wet.moment - wet.volume * (centre + along * s)).norm(), 1e-13);
  }
}

TEST(Hydrostatics, MeshOfASphereTendsToIt) {
  // Caps of the mesh with the sphere's volume: errors of second order in the edge length.
  double before = 1;
  for (const int level : {2, 3, 4}) {
    FluidBody body = test::hullBody(test::geodesicSphere(level));
    body.volume = 4 * kPi / 3;
    const PackedHull hull(body);
    double error = 0;
    for (int i = 1; i < 20; ++i) {
      const SurfacePlane plane = planeAt({0.3, 0.5, 0.8}, -1 + 0.1 * i);
      const WetVolume of_mesh = computeWetVolume(hull, plane);
      const WetVolume exact = computeWetSphere(1, {0, 0, 0}, plane);
      error = std::max(error, std::abs(of_mesh.volume - exact.volume));
      error = std::max(error, (of_mesh.moment - exact.moment).norm());
      error = std::max(error, (of_mesh.waterplane.spread - exact.waterplane.spread).norm());
    }
    EXPECT_LT(error, before / 3.5);
    before = error;
  }
  EXPECT_LT(before, 4e-3);
}

TEST(Hydrostatics, WrenchIsTheGradientOfTheEnergy) {
  Arbitrary arbitrary(3);
  for (int i = 0; i < 50; ++i) {
    const PackedHull hull(test::bumpyBody(arbitrary));
    const Vector3 s = arbitrary.vector().normalized();
    const double h = arbitrary.between(-0.8, 0.8);
    const Twist x = arbitrary.twist();
    // Surface plane in body axes a moment before and after, eq. (52).
    const double moment = 1e-5;
    const auto energyAfter = [&](double t) {
      const SurfacePlane moved = planeAt(s + t * s.cross(x.angular), h - t * s.dot(x.linear));
      // The moved normal has unit length to second order, which limits the difference quotient.
      return hydrostaticEnergy(computeWetVolume(hull, moved), moved);
    };
    const SurfacePlane plane = planeAt(s, h);
    const WetVolume wet = computeWetVolume(hull, plane);
    const double rate = (energyAfter(moment) - energyAfter(-moment)) / (2 * moment);
    EXPECT_NEAR(power(hydrostaticWrench(wet, plane), x), -rate, 1e-8);
    const auto volumeAt = [&](double height) {
      return computeWetVolume(hull, planeAt(s, height)).volume;
    };
    EXPECT_NEAR((volumeAt(h + moment) - volumeAt(h - moment)) / (2 * moment), wet.waterplane.area,
                1e-8);
  }
}

TEST(Hydrostatics, ExtentIsThatOfTheCornersInEveryDirection) {
  Arbitrary arbitrary(1);
  test::Triangulation mesh = test::geodesicSphere(3);
  for (Vector3& v : mesh.vertices) v = arbitrary.between(0.5, 2) * v + Vector3(1, 2, 3);
  const PackedHull hull(test::hullBody(mesh));
  for (int i = 0; i < 100; ++i) {
    const Vector3 s = arbitrary.vector().normalized();
    double low = 1e9, high = -1e9;
    for (const Vector3& v : mesh.vertices) {
      low = std::min(low, s.dot(v));
      high = std::max(high, s.dot(v));
    }
    EXPECT_EQ(computeExtent(hull, s).first, low);
    EXPECT_EQ(computeExtent(hull, s).second, high);
  }
}

TEST(Hydrostatics, MovesWithTheFrame) {
  Arbitrary arbitrary(4);
  const PackedHull box(boxBody({2, 1, 0.5}));
  for (int i = 0; i < 20; ++i) {
    const FrameOffset frame{arbitrary.rotation(), arbitrary.vector()};
    const Twist x = arbitrary.twist();
    const SurfacePlane in_B = planeAt(arbitrary.vector(), arbitrary.between(-1, 1));
    const SurfacePlane in_F = seenFrom(in_B, frame);
    const WetVolume wet_F = computeWetVolume(box, in_F);
    EXPECT_NEAR(power(hydrostaticWrench(wet_F.inB(frame), in_B), x),
                power(hydrostaticWrench(wet_F, in_F), frame.toF(x)), 1e-12);
    const Waterplane plane = wet_F.inB(frame).waterplane;
    EXPECT_NEAR(plane.area > 0 ? in_B.depth(plane.centroid) : 0, 0, 1e-12);
    EXPECT_LT((plane.spread * in_B.normal).norm(), 1e-12);
  }
}

TEST(Hydrostatics, DryAndSubmergedBodiesAreAllOrNothing) {
  const PackedHull box(boxBody({2, 1, 0.5}, 3));
  const Vector3 s = Vector3(1, 2, 3).normalized();
  EXPECT_EQ(computeWetVolume(box, planeAt(s, -2)).volume, 0);
  EXPECT_EQ(computeWetVolume(box, planeAt(s, -2)).waterplane.area, 0);
  const WetVolume all = computeWetVolume(box, planeAt(s, 2));
  EXPECT_NEAR(all.volume, 1, 5e-15);
  EXPECT_NEAR(all.depth_integral, 2, 1e-14);
  EXPECT_LT(all.moment.norm(), 5e-15);
  EXPECT_EQ(all.waterplane.area, 0);
}

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
