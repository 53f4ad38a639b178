#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "bullet_ambient/base/pi.h"
#include "bullet_ambient/force/loads/surface_loads.h"
#include "preprocess/resistance/prepare.h"
#include "preprocess/resistance/separation.h"
#include "preprocess/resistance/stokes_resistance.h"
#include "tests/reference/ellipsoid_added_mass.h"
#include "tests/support/bodies/hull_bodies.h"
#include "tests/support/bodies/random_bodies.h"

// Loads on bodies at any Reynolds number, against the numbers of a program of their own,
// docs/theory.md section 19.

namespace ambient {
namespace {

FluidBody ellipsoid(const Vector3& semi_axes) {
  FluidBody body = test::hullBody(test::geodesicEllipsoid(semi_axes, 4));
  body.added_mass = reference::ellipsoidAddedMass(semi_axes).asDiagonal();
  KnownViscousFlow known{ellipsoidResistance(semi_axes).asDiagonal(),
                         ellipsoidSeparation(semi_axes, 8000)};
  if (semi_axes == Vector3(2, 1, 1)) {  // by the integrals over the meridian
    const SeparationWay along{0.9245, 0.06535, 0.06535, 0.4225, 0.6296, 8.450, 0.09298, 0.5402},
        across{2.560, 0.5481, 0.8608, 1.905, 0.2869, 6.796, 0.09683, 0.3387};
    known.separation->ways = {along, along, across, across, across, across};
  }
  prepare(body, known);
  return body;
}

/// Load on a body that moves by x in a fluid of density 1 at Re = D_A/mu.
Wrench loadAt(const FluidBody& body, const Twist& x, double reynolds) {
  const Medium fluid{1, body.viscous.surface.diameter / reynolds, {0, 0, 0}, {0, 0, 0}};
  FlowSettings flow;
  flow.precision = LoadPrecision::kDouble;
  return makeSurfaceLoads(std::make_shared<const FluidBody>(body), fluid, flow)->load(x);
}

double dragAlong(const FluidBody& body, int axis, double reynolds, double area) {
  const Twist x{{0, 0, 0}, Vector3::Unit(axis)};
  return -2 * loadAt(body, x, reynolds).force[axis] / area;
}

TEST(BodyLaw, DragOfASpheroidHasItsNumbersFromStokesToTheCrisis) {
  const FluidBody body = ellipsoid({2, 1, 1});
  const double reynolds[] = {1, 10, 100, 1e3, 1e4, 1e5, 2e5, 1e6, 1e7};
  const double along[] = {42.296,  6.3285,   1.3088,   0.41092, 0.25587,
                          0.15399, 0.044443, 0.046959, 0.0404};
  const double across[] = {24.778,  4.0614,  1.1256,  0.54234, 0.52554,
                           0.64584, 0.65118, 0.17590, 0.25360};
  for (int i = 0; i < 9; ++i) {
    SCOPED_TRACE(reynolds[i]);
    EXPECT_NEAR(dragAlong(body, 0, reynolds[i], kPi) / along[i], 1, 0.02);
    EXPECT_NEAR(dragAlong(body, 1, reynolds[i], 2 * kPi) / across[i], 1, 0.02);
  }
}

TEST(BodyLaw, LoadOnAnInclinedSpheroidHasItsNumbers) {
  const FluidBody body = ellipsoid({2, 1, 1});
  const Twist x{{0, 0, 0.1}, Vector3(1, 1, 0).normalized()};
  const double expected[][4] = {{1e3, -1.1189, -0.85087, 0.89077},
                                {1e5, -1.1163, -1.2418, 1.8699},
                                {1e6, -0.61428, -0.14272, 1.0727}};
  for (const auto& row : expected) {
    SCOPED_TRACE(row[0]);
    const Wrench load = loadAt(body, x, row[0]);
    EXPECT_NEAR(load.force.x(), row[1], 0.02 * std::abs(row[1]));
    EXPECT_NEAR(load.force.y(), row[2], 0.02);
    EXPECT_NEAR(load.torque.z(), row[3], 0.02 * row[3]);
  }
}

TEST(BodyLaw, CreepsByTheResistanceAlone) {
  const FluidBody body = ellipsoid({1, 2, 3});
  const Twist x{{0.3, -0.2, 0.1}, {1, 2, -1}};
  const double reynolds = 1e-5, viscosity = body.viscous.surface.diameter / reynolds;
  const Vector6 creeping = -viscosity * (body.viscous.resistance * x.vector());
  EXPECT_LT((loadAt(body, x, reynolds).vector() - creeping).norm(), 1e-3 * creeping.norm());
}

TEST(BodyLaw, TakesEnergyInEveryMotion) {
  test::Arbitrary random(7);
  for (const Vector3& axes : {Vector3(1, 1, 4), Vector3(0.3, 1, 1), Vector3(1, 2, 3)}) {
    const FluidBody body = ellipsoid(axes);
    for (int i = 0; i < 300; ++i) {
      const Twist x{random.vector(std::exp2(random.between(-20, 20))),
                    random.vector(std::exp2(random.between(-20, 20)))};
      const Wrench load = loadAt(body, x, std::exp2(random.between(-20, 25)));
      EXPECT_LT(power(load, x), 1e-12 * load.vector().norm() * x.vector().norm());
    }
  }
}

TEST(BodyLaw, ForceGoesWithTheSpeedAtAnySpin) {
  const FluidBody body = ellipsoid({1, 1, 2});
  const auto force = [&](double speed, double reynolds) {
    return loadAt(body, {{3, 1, 0.5}, {speed, 0.3 * speed, 0}}, reynolds).force.norm();
  };
  for (const double reynolds : {1.0, 1e4, 1e6}) {
    EXPECT_LT(force(1e-6, reynolds), 2e-3 * force(1e-3, reynolds));
    EXPECT_LT(force(0, reynolds), 1e-12);
  }
}

}  // namespace
}  // namespace ambient
