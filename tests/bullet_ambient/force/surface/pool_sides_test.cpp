#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <tuple>
#include <vector>

#include "bullet_ambient/force/loads/surface_loads.h"
#include "bullet_ambient/force/surface/hydrostatics.h"
#include "bullet_ambient/force/surface/wetted_inertia.h"
#include "bullet_ambient/spatial/rotation.h"
#include "preprocess/base/surface_form.h"
#include "tests/support/bodies/part_bodies.h"
#include "tests/support/bodies/random_bodies.h"

// The part of a body that is below the surface and between the sides of a pool, docs/theory.md
// section 17.
namespace ambient {
namespace {

using test::Arbitrary;

SurfacePlane surfaceAt(const Vector3& normal, double height) {
  return {normal.normalized(), height, 1, 1};
}

/// Sides at places along a normal of which only what is across the surface counts.
PoolSides sidesAt(const Vector3& normal, const std::vector<Vector3>& points) {
  PoolSides sides;
  for (const Vector3& point : points) sides.of[sides.count++] = {normal, point};
  return sides;
}

Vector3 alongSurface(const Vector3& v, const Vector3& normal) {
  return (v - v.dot(normal) * normal).normalized();
}

PoolSides outsideOf(PoolSides sides) {
  for (int i = 0; i < sides.count; ++i) sides.of[i].normal *= -1;
  return sides;
}

void expectSum(const WetVolume& a, const WetVolume& b, const WetVolume& whole) {
  EXPECT_NEAR(a.volume + b.volume, whole.volume, 1e-12);
  EXPECT_LT((a.moment + b.moment - whole.moment).norm(), 1e-12);
  EXPECT_NEAR(a.depth_integral + b.depth_integral, whole.depth_integral, 1e-12);
  const Waterplane &p = a.waterplane, &q = b.waterplane, &all = whole.waterplane;
  EXPECT_NEAR(p.area + q.area, all.area, 1e-12);
  EXPECT_LT((p.area * p.centroid + q.area * q.centroid - all.area * all.centroid).norm(), 1e-12);
  const auto about = [&all](const Waterplane& part) -> Matrix3 {
    const Vector3 r = part.centroid - all.centroid;
    return part.spread + part.area * r * r.transpose();
  };
  if (all.area > 0) {
    EXPECT_LT((about(p) + about(q) - all.spread).norm(), 1e-12);
  }
}

TEST(PoolSides, BothPartsOfABodyMakeUpTheWhole) {
  Arbitrary arbitrary(1);
  const PackedHull hull(test::bumpyBody(arbitrary));
  for (int i = 0; i < 200; ++i) {
    SurfacePlane plane = surfaceAt(arbitrary.vector(), arbitrary.between(-1, 1));
    const WetVolume whole = computeWetVolume(hull, plane);
    const PoolSides in = sidesAt(alongSurface(arbitrary.vector(), plane.normal),
                                 {arbitrary.between(0, 1) * arbitrary.vector()});
    const PoolSides out = outsideOf(in);
    plane.sides_F = &in;
    const WetVolume inside = computeWetVolume(hull, plane);
    plane.sides_F = &out;
    expectSum(inside, computeWetVolume(hull, plane), whole);
  }
}

TEST(PoolSides, ABoxInACornerIsABox) {
  const Vector3 size(2, 1, 0.5);
  const PackedHull box(test::boxBody(size, 3));
  PoolSides sides;
  sides.count = 2;
  sides.of[0] = {Vector3::UnitX(), {0.3, 7, 7}};
  sides.of[1] = {-Vector3::UnitY(), {7, -0.2, 7}};
  SurfacePlane plane = surfaceAt({0, 0, 1}, 0.05);
  plane.sides_F = &sides;
  const WetVolume wet = computeWetVolume(box, plane);
  const double x = 1.3, y = 0.7, depth = 0.3;
  EXPECT_NEAR(wet.volume, x * y * depth, 1e-14);
  const Vector3 centre(0.3 - x / 2, -0.2 + y / 2, 0.05 - depth / 2);
  EXPECT_LT((wet.moment - wet.volume * centre).norm(), 1e-14);
  EXPECT_NEAR(wet.depth_integral, x * y * depth * depth / 2, 1e-14);
  EXPECT_NEAR(wet.waterplane.area, x * y, 1e-14);
  EXPECT_LT((wet.waterplane.centroid - Vector3(centre.x(), centre.y(), 0.05)).norm(), 1e-14);
  const Vector3 spread = x * y / 12 * Vector3(x * x, y * y, 0);
  EXPECT_LT((wet.waterplane.spread - Matrix3(spread.asDiagonal())).norm(), 1e-14);
  // The water presses at two thirds of its depth.
  const Wrench push = computeSidePush(box, plane);
  const Vector3 at_x(0.3, centre.y(), 0.05 - depth * 2 / 3), at_y(centre.x(), -0.2, at_x.z());
  Wrench expected = Wrench::ofForceAt(y * depth * depth / 2 * Vector3::UnitX(), at_x);
  expected += Wrench::ofForceAt(-x * depth * depth / 2 * Vector3::UnitY(), at_y);
  EXPECT_LT((push.vector() - expected.vector()).norm(), 1e-14);
}

TEST(PoolSides, ThatDoNotCutChangeNothing) {
  Arbitrary arbitrary(2);
  const PackedHull hull(test::bumpyBody(arbitrary));
  for (int i = 0; i < 50; ++i) {
    SurfacePlane plane = surfaceAt(arbitrary.vector(), arbitrary.between(-1, 1));
    const WetVolume open = computeWetVolume(hull, plane);
    const Vector3 m = alongSurface(arbitrary.vector(), plane.normal);
    const PoolSides sides = sidesAt(m, {3 * m});
    plane.sides_F = &sides;
    expectSum(computeWetVolume(hull, plane), {}, open);
    EXPECT_LT(computeSidePush(hull, plane).vector().norm(), 1e-12);
  }
}

// Force and torque are the gradient of the energy: of moving the side, and of turning the body.
TEST(PoolSides, PressByTheGradientOfTheEnergy) {
  Arbitrary arbitrary(3);
  const PackedHull hull(test::bumpyBody(arbitrary));
  for (int i = 0; i < 20; ++i) {
    const SurfacePlane plane = surfaceAt(arbitrary.vector(), arbitrary.between(-0.3, 0.5));
    const Vector3 m = alongSurface(arbitrary.vector(), plane.normal);
    const Vector3 point = 0.4 * arbitrary.vector();
    const auto energyAt = [&](const Vector3& way, const Vector3& turn) {
      const Matrix3 R = rotationFromVector(turn).toRotationMatrix();
      // The body moves by `way`, and turns about F's origin: the pool goes the other way.
      const PoolSides moved = sidesAt(R.transpose() * m, {R.transpose() * (point - way)});
      SurfacePlane seen = seenFrom(plane, R, way);
      seen.sides_F = &moved;
      return hydrostaticEnergy(computeWetVolume(hull, seen), seen);
    };
    const PoolSides sides = sidesAt(m, {point});
    SurfacePlane cut = plane;
    cut.sides_F = &sides;
    Wrench wrench = hydrostaticWrench(computeWetVolume(hull, cut), cut);
    wrench += computeSidePush(hull, cut);
    const double step = 1e-5;
    Wrench expected;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 e = step * Vector3::Unit(axis), none(0, 0, 0);
      expected.force[axis] = -(energyAt(e, none) - energyAt(-e, none)) / (2 * step);
      expected.torque[axis] = -(energyAt(none, e) - energyAt(none, -e)) / (2 * step);
    }
    EXPECT_LT((wrench.vector() - expected.vector()).norm(), 1e-7);
  }
}

/// Added mass of an ellipsoid with parts, by the plane of the surface.
struct LongBody {
  LongBody() : inertia(makeWettedInertia(body)) {}

  Immersion at(double height, const PoolSides* sides) const {
    Immersion at{{Vector3::UnitZ(), height, 1000, 9.81, sides}, 0, 0, {}};
    std::tie(at.low, at.high) = computeExtent(hull, at.plane.normal);
    at.wet = computeWetVolume(hull, at.plane);
    return at;
  }

  std::shared_ptr<const FluidBody> body =
      std::make_shared<FluidBody>(test::floatingEllipsoid({1, 0.2, 0.1}, 3));
  PackedHull hull{*body};
  std::shared_ptr<const WettedInertia> inertia;
};

TEST(PoolSides, BothPartsOfTheAddedMassMakeUpTheWhole) {
  const LongBody ship;
  const Twist x{{0.1, 0.3, -0.2}, {1, -0.4, 0.7}};
  for (const double height : {-0.05, 0.03, 1.0}) {
    const Matrix6 whole = ship.inertia->inertia(ship.at(height, nullptr));
    const InertiaGradient slope = ship.inertia->gradient(ship.at(height, nullptr), x);
    for (const double place : {-0.7, 0.0, 0.2}) {
      const PoolSides in = sidesAt(Vector3::UnitX(), {{place, 0, 0}}), out = outsideOf(in);
      const Immersion inside = ship.at(height, &in), outside = ship.at(height, &out);
      const Matrix6 K = ship.inertia->inertia(inside);
      EXPECT_LT((K + ship.inertia->inertia(outside) - whole).norm(), 1e-12 * whole.norm());
      if (inside.isDeep() || height > 0.5) continue;  // the rise goes with the centre of a part
      const double by_height = ship.inertia->gradient(inside, x).by_height +
                               ship.inertia->gradient(outside, x).by_height;
      EXPECT_NEAR(by_height, slope.by_height, 1e-12 * std::abs(slope.by_height));
    }
    // Half of the body has half of the added mass across.
    const PoolSides middle = sidesAt(Vector3::UnitX(), {{0, 0, 0}});
    const Matrix6 half = ship.inertia->inertia(ship.at(height, &middle));
    for (const int i : {4, 5}) EXPECT_NEAR(half(i, i) / whole(i, i), 0.5, 0.01);
  }
}

TEST(PoolSides, BothPartsOfTheLoadMakeUpTheWhole) {
  Arbitrary arbitrary(4);
  FluidBody body = test::hullBody(test::geodesicSphere(3));
  body.faces.sharpness = computeSharpness(body);
  makeSurfaceForm(body);
  const auto shape = std::make_shared<const FluidBody>(body);
  for (const PressureLaw law : {PressureLaw::kPublished, PressureLaw::kForm})
    for (const LoadPrecision precision : {LoadPrecision::kSingle, LoadPrecision::kDouble}) {
      FlowSettings flow;
      flow.law = law;
      flow.precision = precision;
      flow.skin_friction = law == PressureLaw::kPublished;  // that of the form law is of the whole
      const auto loads = makeWaterlineLoads(shape, {1000, 1e-3, {0, 0, 0}, {0, 0, 0}}, flow);
      for (int i = 0; i < 20; ++i) {
        const Twist x = arbitrary.twist();
        const PoolSides in = sidesAt(arbitrary.vector().normalized(), {0.5 * arbitrary.vector()});
        const PoolSides out = outsideOf(in);
        WetPart part{{Vector3::UnitZ(), 1.2, 1000, 9.81}, 0.5};
        part.plane.sides_F = &in;
        const Vector6 inside = loads->wetLoad(x, part).vector();
        part.plane.sides_F = &out;
        const Vector6 outside = loads->wetLoad(x, part).vector();
        part.share = 1;
        part.plane.sides_F = nullptr;
        const Vector6 deep = loads->wetLoad(x, part).vector();
        const double rounding = precision == LoadPrecision::kSingle ? 1e-5 : 1e-13;
        EXPECT_LT((inside + outside - deep).norm(), rounding * deep.norm());
        EXPECT_GT((inside - outside).norm(), 0.01 * deep.norm());
      }
    }
}

}  // namespace
}  // namespace ambient
